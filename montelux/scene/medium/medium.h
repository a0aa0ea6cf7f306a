// Medium: the variant of all participating media, one file per kind; all satisfy MediumModel.
#pragma once

#include <type_traits>
#include <variant>

#include "montelux/scene/medium/cloud_medium.h"
#include "montelux/scene/medium/field_medium.h"
#include "montelux/scene/medium/grid_medium.h"
#include "montelux/scene/medium/homogeneous_medium.h"
#include "montelux/scene/medium/rgb_grid_medium.h"
#include "montelux/scene/medium/sparse_grid_medium.h"

namespace montelux {

using Medium =
    std::variant<HomogeneousMedium, GridMedium, RgbGridMedium, CloudMedium, SparseGridMedium, FieldMedium>;
static_assert(std::is_trivially_copyable_v<Medium>);

template <typename... M>
constexpr bool all_are_medium_models(std::type_identity<std::variant<M...>>) {
    return (MediumModel<M> && ...);
}
static_assert(all_are_medium_models(std::type_identity<Medium>{}));

} // namespace montelux
