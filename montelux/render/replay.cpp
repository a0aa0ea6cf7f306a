// Replaying single samples.
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/render/renderer.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/sample_record.h"
#include "montelux/scene/setting_names.h"

namespace montelux {

namespace {

std::string range(int begin, int end) {
    return std::to_string(begin) + (end - begin > 1 ? " to " + std::to_string(end - 1) : "");
}

} // namespace

void check_sample(const SceneDescription& d, int x, int y, std::uint64_t index, const RenderTarget& target) {
    if (d.integrator.method == IntegratorKind::metropolis)
        throw Error(
            "metropolis",
            "a state of a chain follows from all before it and cannot be traced alone; replay a sample of "
            "the integrator path");
    const PixelBounds& crop = d.film.crop;
    if (x < crop.x0 || x >= crop.x1 || y < crop.y0 || y >= crop.y1) {
        const bool whole = crop == PixelBounds{0, 0, d.film.width, d.film.height};
        throw Error("pixel " + std::to_string(x) + "," + std::to_string(y),
                    std::string(whole ? "the film" : "the crop of the film") + " has columns " +
                        range(crop.x0, crop.x1) + " and rows " + range(crop.y0, crop.y1));
    }
    if (!target.adaptive && index >= d.sampler.spp)
        throw Error("sample " + std::to_string(index),
                    "the pixel has " + std::to_string(d.sampler.spp) + " samples, counted from 0");
}

SampleRecord Renderer::replay(int x, int y, std::uint64_t index) const {
    check_sample(description_, x, y, index, target_);
    if (description_.integrator.guiding != Guiding::off)
        throw Error("guiding",
                    "a guided sample depends on what the render has learned before it: replay samples with "
                    "guiding off");
    if (description_.integrator.manifold_sampling)
        throw Error("manifold sampling",
                    "its light is no part of the trace of a sample; replay samples with it off");
    if (traces_light(description_.integrator.method))
        throw Error("integrator " + std::string(name_of(description_.integrator.method)),
                    "its samples cannot be replayed: they have many paths; choose 'path'");
    RayTracer tracer(accelerator());
    return SampleContext(description_, sampler_, scene(), camera_).record(tracer, {x, y, index});
}

} // namespace montelux
