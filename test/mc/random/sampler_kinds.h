// Every kind of sampler, with its name in tests.
#pragma once

#include <array>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/random/sample_stream.h"

namespace montelux::testing {

inline constexpr std::array all_kinds = {SamplerKind::independent, SamplerKind::stratified,
                                         SamplerKind::halton,      SamplerKind::hammersley,
                                         SamplerKind::sobol,       SamplerKind::sobol_blue_noise};
inline constexpr std::array kind_names = {"independent", "stratified", "halton",
                                          "hammersley",  "sobol",      "sobol_blue_noise"};

inline std::string kind_name(const ::testing::TestParamInfo<SamplerKind>& kind) {
    return kind_names[static_cast<std::size_t>(kind.param)];
}

} // namespace montelux::testing
