// ViewOptions: how a running render is shown in browsers and in tev.
#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace montelux::app {

struct ViewOptions {
    bool page = false;  // --view, or the command view
    bool stays = false; // the command view: the program waits after the render
    std::string host = "127.0.0.1";
    std::uint64_t port = 0; // 0: the system chooses
    std::string reference;  // a picture to compare with
    std::string tev;        // HOST:PORT

    // Whether anyone watches.
    bool any() const { return page || !tev.empty(); }
};

// --host, --port, --reference and --tev; of the command render also --view.
void declare_view(CLI::App& command, ViewOptions& options, bool is_render);
// Throws UsageError for options that have no effect.
void check(const ViewOptions& options);

} // namespace montelux::app
