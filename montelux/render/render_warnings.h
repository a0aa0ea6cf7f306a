// Warnings about a finished render, as sentences.
#pragma once

#include <string>

#include "montelux/render/render_session.h"

namespace montelux {

// The samples left out, and how to replay the first; empty without any.
std::string bad_sample_warning(const BadSampleReport& bad, std::uint64_t seed);

// Of a Metropolis render whose chains do not agree, or found no light; empty otherwise.
std::string chain_warning(const ChainStatistics& chains);

// Of a render whose paths merged: that its picture is consistent, not unbiased, and how large the bias is; empty for
// others.
std::string merging_notice(const RenderSnapshot& result, const RenderTarget& target);
// That nothing merged, or that its light paths did not fit into the memory; empty otherwise.
std::string merging_warning(const MergingSummary& merging);

// That manifold sampling finds no caster or no light to sample; empty if it does, or is off.
std::string manifold_warning(const Renderer& renderer);

// For an interrupted render whose picture has no errors; empty if they are known, and for slices, which get
// errors when they are merged.
std::string missing_error_warning(const RenderSnapshot& result, const Renderer& renderer);

// For a picture in which most pixels that see a surface are black after eight samples or more: what may be missing;
// empty for others, and where the picture has no layer of depths.
std::string black_warning(const Image& picture, double spp, const Scene& scene);

// How much light path tracing does not find, of which light, and what finds it; empty where that does not matter.
std::string missing_light_warning(const RenderSnapshot& result, const RenderTarget& target,
                                  const SceneDescription& description);

} // namespace montelux
