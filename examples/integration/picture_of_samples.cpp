// Draws the samples of Adaptive for a disc and for two narrow peaks, as an SVG on standard output: grey the
// points of exploration and training, blue those of the estimate.
#include <array>
#include <cmath>
#include <iostream>
#include <montelux/mc/integrate/adaptive/adaptive.h>
#include <montelux/mc/integrate/integrate.h>
#include <span>
#include <string>
#include <vector>

using namespace montelux;
using Point = std::array<double, 2>;

double disc(std::span<const double> x) { return std::hypot(x[0] - 0.4, x[1] - 0.55) < 0.3 ? 1 : 0; }
double two_peaks(std::span<const double> x) {
    const double a = std::hypot(x[0] - 0.28, x[1] - 0.3), b = std::hypot(x[0] - 0.72, x[1] - 0.68);
    return std::exp(-1000 * a * a) + std::exp(-1000 * b * b);
}

// One dot for every `stride`-th point, in a square of 1000 units; a path of empty lines with round ends is
// the shortest way.
void draw(std::span<const Point> points, std::size_t stride, const char* style) {
    std::cout << "<path class=\"" << style << "\" d=\"";
    for (std::size_t i = 0; i < points.size(); i += stride)
        std::cout << "M" << std::lround(1000 * points[i][0]) << " " << std::lround(1000 * (1 - points[i][1]))
                  << "h0";
    std::cout << "\"/>\n";
}

void panel(double left, const std::string& title, double (*f)(std::span<const double>)) {
    std::vector<Point> points;
    const Integrand recorded = [&](std::span<const double> x) {
        points.push_back({x[0], x[1]});
        return f(x);
    };
    // One thread, so that the points come in order: exploration, training, then those of the estimate.
    const auto result = integrate(recorded, Domain::unit_cube(2), Adaptive{}, {.evaluations = 1 << 16},
                                  {.seed = 1, .threads = 1});
    std::cout << "<g transform=\"translate(" << left << " 60) scale(0.4)\">\n"
              << "<text y=\"-40\">" << title << ": " << result.estimate() << "</text>\n"
              << "<rect width=\"1000\" height=\"1000\"/>\n";
    const std::span<const Point> all = points;
    draw(all.first(2048), 2, "early");
    draw(all.last(all.size() / 2), 9, "late"); // 9: no divisor of the numbers of Sobol' points
    std::cout << "</g>\n";
}

int main() {
    std::cout << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 880 480\">\n"
              << "<style>text{font:40px sans-serif}rect{fill:#fff;stroke:#333;stroke-width:2}"
              << "path{stroke-linecap:round;stroke-width:5}.early{stroke:#bbb}.late{stroke:#15c}</style>\n"
              << "<rect width=\"880\" height=\"480\" style=\"stroke:none\"/>\n";
    panel(20, "disc", disc);
    panel(460, "two peaks", two_peaks);
    std::cout << "</svg>\n";
}
