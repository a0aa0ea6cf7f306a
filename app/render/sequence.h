// render_sequence: the frames of an animation or of a turntable, each a picture of its own.
#pragma once

#include "app/render/cluster_render.h"
#include "app/render/render_options.h"

namespace montelux::app {

// For --frames and --turntable. Frames that are finished (FrameLog) are skipped; a signal ends the sequence, and
// leaves those that were finished. Returns the exit code of the program. Throws UsageError and Error; frames that were
// finished before stay.
int render_sequence(const RenderOptions& options, SharedRender& shared);

} // namespace montelux::app
