// Medium: the variant of all participating media, one file per kind; all satisfy MediumModel.
#pragma once

#include <optional>
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

// Outside of which there is nothing; empty of media that fill all space.
inline std::optional<MediumBox> box_of(const Medium& medium) {
    return std::visit(
        [](const auto& m) -> std::optional<MediumBox> {
            using M = std::decay_t<decltype(m)>;
            if constexpr (M::homogeneous)
                return std::nullopt;
            else if constexpr (std::is_same_v<M, FieldMedium>)
                return m.bounded ? std::optional(m.box) : std::nullopt;
            else
                return m.box;
        },
        medium);
}

} // namespace montelux
