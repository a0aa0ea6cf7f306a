// TevStream: a running render shown by the image viewer tev, which listens on a port.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "montelux/view/viewed_render.h"

namespace montelux {

// Sends the mean and the standard error of luminance ("error.Y") as they change, several times a second, on a thread of
// its own, by the protocol of tev 1.19 and later (its src/Ipc.cpp). A tev that is closed ends the stream and nothing
// else.
class TevStream {
  public:
    // `where`: HOST:PORT, tev's own being 127.0.0.1:14158. `name`: of the picture. The render must outlive the stream.
    // Throws Error where nothing listens.
    TevStream(ViewedRender& render, const std::string& where, std::string name);
    // Sends what has changed and ends.
    ~TevStream();
    TevStream(const TevStream&) = delete;
    TevStream& operator=(const TevStream&) = delete;

  private:
    class Connection;
    void run();
    void send_until_the_end();

    ViewedRender& render_;
    std::string name_;
    std::unique_ptr<Connection> connection_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

} // namespace montelux
