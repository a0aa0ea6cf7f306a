// ViewServer: the page of a render, served to browsers by a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "montelux/view/view_messages.h"
#include "montelux/view/viewed_render.h"

namespace montelux {

struct ViewServerSettings {
    // An IP address of this machine. Any but a loopback one shows the render to the network.
    std::string address = "127.0.0.1";
    std::uint16_t port = 0; // 0: the system chooses
    ViewIntroduction introduction{};
};

// Answers only requests that know its token, and that a page of its own or a program has made (view_access.h). Neither
// the number of connections nor slow or silent ones take more memory or delay the render.
class ViewServer {
  public:
    // The render must outlive the server. Throws Error for an address or port that cannot be served.
    ViewServer(ViewedRender& render, const ViewServerSettings& settings);
    // Tells the pages that the program ends, and waits a second at most until they know.
    ~ViewServer();
    ViewServer(const ViewServer&) = delete;
    ViewServer& operator=(const ViewServer&) = delete;

    // With the token.
    std::string url() const;

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace montelux
