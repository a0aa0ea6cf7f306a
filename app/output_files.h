// The files that a command writes: names that are refused, and failures of single files.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::app {

// Throws UsageError where one of the outputs is a file that is read (under this name, by a link or under
// another name of the same file), and where two of them have one name. Empty names are ignored.
void check_output_names(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

// Throws Error for a name that ends in none of the extensions; case does not matter.
void check_extension(const std::string& path, const std::vector<std::string_view>& extensions);

// Writes one file after the other; a failure does not stop the others.
class OutputFiles {
  public:
    // Calls `write`; what it throws is kept until throw_failures().
    void write(const std::string& path, const std::function<void()>& write);
    // Paths that were written.
    const std::vector<std::string>& written() const { return written_; }
    // Throws all failures as one Error, if there were any.
    void throw_failures() const;

  private:
    std::vector<std::string> written_;
    std::string failures_;
};

} // namespace montelux::app
