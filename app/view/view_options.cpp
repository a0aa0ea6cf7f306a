#include "app/view/view_options.h"

#include "app/option_values.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>

namespace montelux::app {

void declare_view(CLI::App& c, ViewOptions& o, bool is_render) {
    if (is_render)
        c.add_flag(
            "--view", o.page,
            "Show the render in a browser while it runs: its address is printed ('montelux view' stays "
            "afterwards)");
    const std::string of = is_render ? "With --view: " : "";
    add_whole_number(c, "--port", o.port, 0, 65535, of + "the port of the page. Default: one that is free");
    c.add_option(
         "--host", o.host,
         of + "the IP address of this machine that serves the page. Default: 127.0.0.1, which other machines "
              "cannot reach")
        ->type_name("ADDRESS")
        ->take_last();
    c.add_option("--reference", o.reference, of + "a picture of the same size, to compare with")
        ->type_name("FILE")
        ->check(file_name())
        ->take_last();
    c.add_option("--tev", o.tev,
                 "Show the render in the image viewer tev, which listens there (127.0.0.1:14158)")
        ->type_name("HOST:PORT")
        ->take_last();
}

void check(const ViewOptions& o) {
    if (o.page) return;
    const ViewOptions unset;
    if (o.port != unset.port) throw UsageError("--port", "it is the port of the page that --view serves");
    if (o.host != unset.host) throw UsageError("--host", "it is the address of the page that --view serves");
    if (!o.reference.empty())
        throw UsageError("--reference", "it is compared with on the page that --view serves");
}

} // namespace montelux::app
