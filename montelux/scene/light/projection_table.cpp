#include "montelux/scene/light/projection_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "montelux/mc/math/constants.h"

namespace montelux {

namespace {

// visit(texel, solid angle times intensity_of_white) for the texels of a screen, row by row.
template <typename Visit>
void visit_texels(const ProjectionScreen& screen, ProjectionProfile profile, const Visit& visit) {
    std::size_t i = 0;
    for (int y = 0; y < screen.height(); ++y)
        for (int x = 0; x < screen.width(); ++x, ++i) {
            const Vec3f w = screen.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
            visit(i, double(screen.solid_angle(w.z) * intensity_of_white(profile, w.z)));
        }
}

double weighted(const Image& picture, std::size_t texel, Vec3d weights) {
    const std::size_t i = texel * static_cast<std::size_t>(picture.channels());
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
        sum += weights[static_cast<int>(c)] * std::max(0.0, double(picture.value_at(i + c)));
    return sum;
}

// The mean of each texel and its neighbours.
Image blurred(const Image& picture, PictureLookup lookup) {
    const auto within = [&](int i, int n) {
        return lookup == PictureLookup::repeating ? (i + n) % n : std::clamp(i, 0, n - 1);
    };
    Image result(picture.width(), picture.height(), {"R", "G", "B"});
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                float sum = 0;
                for (int k = 0; k < 9; ++k)
                    sum += picture.value(within(x + k % 3 - 1, picture.width()),
                                         within(y + k / 3 - 1, picture.height()), c);
                result.set(x, y, c, sum / 9);
            }
    return result;
}

std::vector<double> texel_flux(const Image& picture, const ProjectionScreen& screen,
                               ProjectionProfile profile, Vec3d weights) {
    std::vector<double> flux(picture.pixel_count());
    visit_texels(screen, profile,
                 [&](std::size_t i, double angle) { flux[i] = weighted(picture, i, weights) * angle; });
    return flux;
}

} // namespace

ProjectionScreen::ProjectionScreen(int width, int height, float fov) : width_(width), height_(height) {
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const float shorter = std::tan(0.5f * fov * pi_f / 180);
    half_ = w > h ? Vec2f{shorter * w / h, shorter} : Vec2f{shorter, shorter * h / w};
    texel_area_ = 4 * half_.x * half_.y / (w * h);
}

std::optional<Vec2f> ProjectionScreen::locate(Vec3f w) const {
    if (!(w.z > 0)) return std::nullopt;
    const float x = 0.5f * (w.x / (w.z * half_.x) + 1), y = 0.5f * (w.y / (w.z * half_.y) + 1);
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return std::nullopt;
    const Vec2f texels{x * static_cast<float>(width_), y * static_cast<float>(height_)};
    return Vec2f{std::min(texels.x, std::nextafter(static_cast<float>(width_), 0.0f)),
                 std::min(texels.y, std::nextafter(static_cast<float>(height_), 0.0f))};
}

Vec3f ProjectionScreen::direction(Vec2f texels) const {
    return normalize(Vec3f((2 * texels.x / static_cast<float>(width_) - 1) * half_.x,
                           (2 * texels.y / static_cast<float>(height_) - 1) * half_.y, 1));
}

ProjectionTable::ProjectionTable(const Image& picture, float fov, ProjectionProfile profile,
                                 PictureLookup lookup)
    : screen_(picture.width(), picture.height(), fov),
      density_(std::span<const double>(
                   texel_flux(profile == ProjectionProfile::irradiance && lookup != PictureLookup::nearest
                                  ? blurred(picture, lookup)
                                  : picture,
                              screen_, profile, Vec3d(1, 1, 1) / 3)),
               static_cast<std::uint32_t>(picture.width()), static_cast<std::uint32_t>(picture.height()),
               {0, 0}, {static_cast<double>(picture.width()), static_cast<double>(picture.height())}) {}

std::optional<ProjectionTable::Sample> ProjectionTable::sample(Vec2f u) const {
    if (!(density_.integral() > 0)) return std::nullopt;
    const auto s = density_.sample(u);
    const Vec3f w = screen_.direction(s.p);
    return Sample{s.p, w, s.pdf / screen_.solid_angle(w.z)};
}

float ProjectionTable::pdf(Vec3f w) const {
    const auto at = screen_.locate(w);
    if (!at || !(density_.integral() > 0)) return 0;
    return density_.pdf(*at) / screen_.solid_angle(normalize(w).z);
}

double projected_flux(const Image& picture, float fov, Vec3d weights) {
    const ProjectionScreen screen(picture.width(), picture.height(), fov);
    double sum = 0;
    for (const double f : texel_flux(picture, screen, ProjectionProfile::intensity, weights)) sum += f;
    return sum;
}

} // namespace montelux
