// Draws the image of the unit square's grid under each warp, as an SVG on standard output. A density is a
// change of area: cells are large where 1/p is large, and dark where p is. Directions are seen from above by
// the projection that keeps areas (Lambert's azimuthal one); its rim is the direction straight down.
#include "known_warps.h"
#include <iostream>

constexpr int cells = 8, steps = 5; // along a side of the square, and of a cell
constexpr int columns = 5, width = 200, height = 225;

Vec2d flat(Vec3d p) { return {p.x, p.y}; }
Vec2d equal_area(Vec3d w) {
    const double r = std::sqrt(std::max(0.0, (1 - w.z) / 2)), across = std::hypot(w.x, w.y);
    return across > 0 ? Vec2d(r * w.x / across, r * w.y / across) : Vec2d(0, 0);
}

// The outline of a cell's image, and the density at its middle.
struct Cell {
    std::vector<Vec2d> outline;
    double pdf;
};
std::vector<Cell> cells_of(const Warp& warp, Vec2d (*paper)(Vec3d)) {
    constexpr double side = 1.0 / cells, inset = 1e-9; // some warps join opposite sides of the square
    std::vector<Cell> all;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const auto at = [&](double s, double t) {
                return warp.sample({std::clamp((i + s) * side, inset, 1 - inset),
                                    std::clamp((j + t) * side, inset, 1 - inset)});
            };
            Cell cell{{}, warp.pdf(at(0.5, 0.5))};
            constexpr std::array<std::array<double, 4>, 4> edges{
                {{0, 0, 1, 0}, {1, 0, 0, 1}, {1, 1, -1, 0}, {0, 1, 0, -1}}};
            for (const auto& [s, t, ds, dt] : edges)
                for (int k = 0; k < steps; ++k)
                    cell.outline.push_back(paper(at(s + ds * k / steps, t + dt * k / steps)));
            all.push_back(std::move(cell));
        }
    return all;
}

void draw(const Warp& warp, Vec2d (*paper)(Vec3d), int place) {
    const std::vector<Cell> all = cells_of(warp, paper);
    Vec2d low = all[0].outline[0], high = low;
    double densest = 0;
    for (const Cell& cell : all) {
        densest = std::max(densest, cell.pdf);
        for (Vec2d p : cell.outline) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    }
    const double scale = (width - 20) / std::max(high.x - low.x, high.y - low.y);
    std::cout << "<g transform=\"translate(" << place % columns * width << " " << place / columns * height
              << ")\">\n"
              << "<text x=\"" << width / 2 << "\" y=\"16\">" << warp.name << "</text>\n";
    for (const Cell& cell : all) {
        std::cout << "<path fill-opacity=\"" << std::round(100 * (0.05 + 0.6 * cell.pdf / densest)) / 100
                  << "\" d=\"M";
        for (Vec2d p : cell.outline)
            std::cout << std::round(10 * (width / 2 + scale * (p.x - (low.x + high.x) / 2))) / 10 << " "
                      << std::round(10 * (25 + (width - 20) / 2 - scale * (p.y - (low.y + high.y) / 2))) / 10
                      << " ";
        std::cout << "z\"/>\n";
    }
    std::cout << "</g>\n";
}

int main() {
    const std::vector<Warp> plane = plane_warps(), sphere = sphere_warps();
    const auto count = static_cast<int>(plane.size() + sphere.size());
    std::cout << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << columns * width << " "
              << (count + columns - 1) / columns * height << "\">\n"
              << "<style>text{font:11px "
                 "sans-serif;text-anchor:middle}path{fill:#15c;stroke:#333;stroke-width:.4}</style>\n"
              << "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
    int place = 0;
    for (const Warp& warp : plane) draw(warp, flat, place++);
    for (const Warp& warp : sphere) draw(warp, equal_area, place++);
    std::cout << "</svg>\n";
}
