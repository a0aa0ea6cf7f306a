#include "montelux/render/render_state.h"

namespace montelux {

std::string_view to_string(RenderStop reason) {
    switch (reason) {
    case RenderStop::samples:
        return "samples";
    case RenderStop::error:
        return "error";
    case RenderStop::time:
        return "time";
    default:
        return "cancelled";
    }
}

} // namespace montelux
