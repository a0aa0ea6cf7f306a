// A child process that answers a line of text with a line of text.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace montelux::bench {

// Its standard input and output are pipes; it ends when its input does.
class Worker {
  public:
    // Throws Error where the program cannot be started.
    explicit Worker(const std::vector<std::string>& command);
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void send(const std::string& line);
    // Nothing once the process has ended.
    std::optional<std::string> receive();

  private:
    pid_t process_ = -1;
    std::FILE* to_ = nullptr;
    std::FILE* from_ = nullptr;
};

} // namespace montelux::bench
