// GuidingField: the directions that light comes from at every place, learned from paths.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/dist/quadtree_density.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/scene/film/film_settings.h"
#include "montelux/transport/guiding/parallax_sphere.h"

namespace montelux {

// The side of a surface: the axis of space that its normal is closest to, or a point in a medium. Points of both
// sides of a thin wall are close to each other, and see different light.
enum class Facing : std::uint8_t { left, right, down, up, back, front, medium };
inline constexpr std::size_t facings = 7;

inline Facing facing_of(Vec3f n) {
    const Vec3f size = abs(n);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<Facing>(2 * axis + (n[axis] > 0 ? 1 : 0));
}

// A part of space where all paths share one density of directions.
struct GuidingRegion {
    ParallaxSphere sphere;
    QuadtreeDensity directions; // from its centre, on equal_area_square
    float share = 0;            // of the directions that are drawn from it; the others are the BSDF's
    float radiance = -1; // mean over vertices that are not glossy of what they scatter; below 0: not known
    float visible = 1;   // share of the light samples that nothing occludes

    bool knows_radiance() const { return radiance >= 0; }
    // Per solid angle.
    float pdf(Point3f p, Vec3f wi) const {
        const ParallaxSphere::Mapped d = sphere.from_centre(p, wi);
        return directions.pdf(equal_area_sphere_to_square(d.w)) * d.density * inv_four_pi_f;
    }
    struct Direction {
        Vec3f wi;
        float pdf = 0;
    };
    Direction sample(Point3f p, Vec2f u) const {
        const QuadtreeDensity::Sample s = directions.sample(u);
        const ParallaxSphere::Mapped d = sphere.from_point(p, equal_area_square_to_sphere(s.p));
        return {d.w, s.pdf * d.density * inv_four_pi_f};
    }
    // Density of directions that are drawn from both, where the BSDF has the density `bsdf_pdf`.
    float mixed_pdf(float guide_pdf, float bsdf_pdf) const {
        return share * guide_pdf + (1 - share) * bsdf_pdf;
    }
};

// Immutable while paths use it: samples are unbiased given the guide, whatever it has learned.
class GuidingField {
  public:
    // Null where no path has been.
    const GuidingRegion* find(Point3f p, Facing facing) const {
        const std::vector<Node>& nodes = trees_[static_cast<std::size_t>(facing)];
        if (nodes.empty()) return nullptr;
        const Node* node = nodes.data();
        while (node->axis < 3) node = &nodes[p[node->axis] < node->split ? node->low : node->high];
        return &regions_[node->low];
    }
    // The radiance that camera rays of a pixel bring on average, roughly; average over the wavelengths. 0: not known.
    float expected(int x, int y) const {
        if (expected_.empty()) return 0;
        const auto row = static_cast<std::size_t>(y - bounds_.y0),
                   column = static_cast<std::size_t>(x - bounds_.x0);
        return expected_[row * static_cast<std::size_t>(bounds_.width()) + column];
    }

    std::size_t regions() const { return regions_.size(); }
    // The part of space of a region, for points of one facing; infinite where only the scene bounds it.
    struct Cell {
        Facing facing{};
        Point3f low, high;
    };
    std::vector<Cell> cells() const;
    std::size_t bytes() const;

    void save(ByteWriter& out) const;
    // Throws Error for what save() did not write.
    static GuidingField load(ByteReader& in);

  private:
    friend class GuidingLearner;

    // A half-space on each side of the plane p[axis] = split; axis 3: `low` is a region.
    struct Node {
        float split = 0;
        std::uint32_t axis = 3;
        std::uint32_t low = 0, high = 0;
    };

    std::array<std::vector<Node>, facings> trees_;
    std::vector<GuidingRegion> regions_;
    PixelBounds bounds_;
    std::vector<float> expected_; // of the pixels of bounds_, row by row
};

} // namespace montelux
