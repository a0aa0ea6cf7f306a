// Ends the program with a sentence on a processor that lacks what it was built for. Runs before all other
// initialisation, which already uses those instructions; compiled for the oldest processor, as the check is.
#include "app/commands.h"
#include <cstring>
#include <unistd.h>

#include "montelux/mc/math/processor.h"

namespace {

void say(const char* text) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(montelux::app::exit_failed);
}

[[gnu::constructor(101)]] void stop_on_an_older_processor() {
    const char* missing = montelux::missing_instructions();
    if (missing == nullptr) return;
    say("montelux: error: this processor has no ");
    say(missing);
    say(", which the program was built for; build it with -D MONTELUX_PROCESSOR=native\n");
    _exit(montelux::app::exit_failed);
}

} // namespace
