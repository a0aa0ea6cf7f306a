// The other ranks of a render, from the start to the end: they prepare the scene, and take samples for the leader.
#pragma once

#include <functional>
#include <string>

#include "montelux/cluster/mailbox.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/renderer.h"

namespace montelux {

// The leader has been silent for too long.
struct LeaderIsSilent : Error {
    using Error::Error;
};

// Calls prepare() in a thread of its own, and meanwhile reports to the leader that this rank is alive: a large scene may
// take longer to build than the leader waits for silent ranks. Rethrows its exceptions.
void prepare_and_beat(Mailbox& mailbox, const std::function<void()>& prepare);

struct ServeSettings {
    int tile_size = 16; // the leader's
    int threads = 1;
    const CancelFlag* cancel = nullptr; // passed on to the leader when it is set
    double patience_seconds = 60;       // with a silent leader
};
// Serves until the leader ends the render. Throws LeaderIsSilent.
void serve_render(const Renderer& renderer, Mailbox& mailbox, const ServeSettings& settings);

// Instead of that, or after it has thrown: reports to the leader why this rank cannot continue, and waits for
// the end of the render. So only the leader prints errors, whether all ranks meet them or a single one.
// Throws LeaderIsSilent.
void serve_failure(const std::string& why, Mailbox& mailbox, double patience_seconds);

} // namespace montelux
