#include "bench/integrate/published.h"
#include <algorithm>

namespace montelux::bench {

namespace {

using enum Family;

struct MedianRow {
    Line line;
    PublishedMedians at_1e3, at_1e4;
};
constexpr MedianRow medians[] = {
    {{oscillatory, 2}, {"Divonne", 4.7e3, 100, 51e3}, {"sobol8", 8.2e3, 200, 572e3}},
    {{product_peak, 2}, {"Divonne", 3.8e3, 500, 13e3}, {"Divonne", 24e3, 1.1e3, 54e3}},
    {{corner_peak, 2}, {"Divonne", 2.0e3, 100, 11e3}, {"sobol8", 8.2e3, 200, 37e3}},
    {{gaussian, 2}, {"Divonne", 4.9e3, 400, 19e3}, {"Divonne", 28e3, 600, 180e3}},
    {{continuous, 2}, {"Divonne", 4.5e3, 1.1e3, 15e3}, {"Divonne", 22e3, 2.1e3, 85e3}},
    {{discontinuous, 2}, {"Divonne", 9.9e3, 28e3, 34e3, false}, {"Divonne", 30e3, 0, 1.4e6, false}},
    {{oscillatory, 5}, {"Divonne", 5.0e3, 300, 87e3}, {"qmc", 33e3, 800, 1.7e6}},
    {{product_peak, 5}, {"Divonne", 9.9e3, 16e3, 26e3}, {"vegas+", 147e3, 134e3, 147e3}},
    {{corner_peak, 5}, {"sobol8", 8.2e3, 800, 21e3}, {"vegas+", 147e3, 9.4e3, 147e3}},
    {{gaussian, 5}, {"Suave", 27e3, 9.8e3, 39e3}, {"sobol8", 172e3, 22e3, 506e3}},
    {{continuous, 5}, {"Suave", 15e3, 220e3, 26e3}, {"vegas+", 147e3, 0, 147e3}},
    {{discontinuous, 5}, {"qmc", 1.6e6, 0, 100e3, false}, {"", 0, 0, 4.1e6, false}},
    {{oscillatory, 8}, {"sobol8", 8.2e3, 400, 100e3}, {"qmc", 33e3, 3.3e3, 3.0e6}},
    {{product_peak, 8}, {"Cuba Vegas Sobol'", 18e3, 59e3, 27e3}, {"vegas+", 170e3, 278e3, 170e3}},
    {{corner_peak, 8}, {"Cuba Vegas Sobol'", 27e3, 3.3e3, 31e3}, {"Divonne", 484e3, 1.3e6, 602e3}},
    {{gaussian, 8}, {"Cuba Vegas Sobol'", 27e3, 106e3, 37e3}, {"vegas+", 283e3, 97e3, 283e3}},
    {{continuous, 8}, {"Cuba Vegas Sobol'", 18e3, 0, 27e3}, {"vegas+", 170e3, 0, 170e3}},
    {{discontinuous, 8}, {"qmc", 2.7e6, 0, 112e3, false}, {"vegas+", 4.4e6, 0, 4.4e6}},
    // One row was printed for the three: 4 to 7 thousand, below 50, 11 to 19 thousand.
    {{sine, 1}, {"Suave", 5.5e3, 50, 11e3}, {"sobol8", 8.2e3, 50, 15e3}},
    {{exponential, 1}, {"Suave", 5.5e3, 50, 11e3}, {"sobol8", 8.2e3, 50, 15e3}},
    {{quadratic, 1}, {"Suave", 5.5e3, 50, 11e3}, {"sobol8", 8.2e3, 50, 15e3}},
    {{inverse_root, 1}, {"Suave", 10e3, 600, 11e3}, {"GSL vegas", 23e3, 800, 45e3, false}},
    {{jump, 1}, {"sobol8", 8.2e3, 300, 11e3, false}, {"qmc", 118e3, 400, 11e3, false}},
    {{two_peaks, 4}, {"Divonne", 86e3, 116e3, 697e3}, {"sobol8", 11.2e6, 437e3, 13.0e6}},
    {{three_peaks, 8}, {"", 0, 0, 12.2e6, false}, {"", 0, 0, 0}},
    {{four_peaks, 8}, {"", 0, 0, 142e3, false}, {"", 0, 0, 2.6e6, false}},
    {{ridge, 4}, {"Divonne", 248e3, 161e3, 627e3}, {"sobol8", 11.2e6, 427e3, 12.1e6}},
    {{ridge, 8}, {"vegas+", 13.6e6, 0, 13.6e6}, {"", 0, 0, 0}},
};

struct ErrorRow {
    Line line;
    PublishedErrors errors;
};
constexpr ErrorRow errors[] = {
    {{oscillatory, 5}, {1.8e-4, 1.3e-4, 9.9e-5, 7.0e-7, 7.0e-7}},
    {{oscillatory, 8}, {2.1e-4, 2.2e-4, 1.0e-4, 2.0e-6, 7.8e-7}},
    {{product_peak, 5}, {8.2e-5, 8.7e-5, 4.3e-6, 3.2e-5, 3.5e-5}},
    {{product_peak, 8}, {9.7e-5, 6.0e-5, 6.0e-6, 3.7e-5, 1.6e-5}},
    {{corner_peak, 5}, {7.7e-5, 5.4e-5, 9.2e-6, 7.7e-6, 2.6e-5}},
    {{corner_peak, 8}, {1.0e-4, 6.1e-5, 2.0e-5, 9.4e-5, 1.2e-4}},
    {{gaussian, 5}, {1.0e-4, 2.3e-4, 1.9e-5, 3.3e-5, 4.6e-5}},
    {{gaussian, 8}, {1.7e-4, 1.6e-4, 2.1e-5, 8.7e-5, 8.2e-5}},
    {{continuous, 5}, {1.1e-4, 1.0e-4, 3.6e-6, 2.3e-5, 6.4e-5}},
    {{continuous, 8}, {1.4e-4, 7.5e-5, 6.3e-6, 1.1e-4, 9.3e-5}},
    {{discontinuous, 5}, {4.8e-4, 1.1e-3, 4.8e-3, 2.6e-3, 4.4e-3}},
    {{discontinuous, 8}, {4.7e-4, 6.6e-4, 3.3e-3, 2.2e-3, 4.6e-3}},
    {{three_peaks, 8}, {8.9e-3, .32, .37, .038, .049}},
};

constexpr PublishedOverhead overheads[] = {
    {"hcubature", "15"},         {"Cuhre", "18"},          {"Boost", "24"},
    {"Cuba Vegas", "33-39"},     {"sobol8 (batch)", "35"}, {"GSL plain", "60"},
    {"GSL miser", "89"},         {"GSL vegas", "98"},      {"qmc", "106"},
    {"vegas+ (C batch)", "180"}, {"Suave", "723"},         {"Divonne", "890"},
    {"torchquad", "5208"},
};

constexpr PublishedHonesty honesty[] = {
    {"sobol8", "0.8 %", "1.7 %", ".59/.90/.98", ".63/.90/.98"},
    {"qmc", "0.6 %", "0", ".61/.91/.99", ".62/1/1"},
    {"GSL miser", "0", "-", ".76/.98/1", ".54/1/1"},
    {"hcubature", "2.7 %", "5.0 %", ".97/.99/.99", ".70/.75/.82"},
    {"Cuhre", "8.0 %", "12.2 %", ".79/.83/.86", ".73/.83/.87"},
    {"GSL vegas", "8.1 %", "1.8 %", ".69/.93/.99", ".43/.70/.73"},
    {"vegas+", "8.8 %", "6.9 %", ".64/.97/1", ".23/.47/.55"},
    {"Cuba Vegas Sobol'", "11.5 %", "16.3 %", ".99/1/1", ".32/.38/.50"},
    {"Divonne", "13.4 %", "9.9 %", ".85/.92/.94", ".38/.49/.58"},
    {"Suave", "29 %", "67 %", ".96/1/1", "0/0/0"},
};

} // namespace

std::optional<PublishedMedians> published_medians(Line line, double relative_error) {
    for (const MedianRow& row : medians) {
        if (row.line != line) continue;
        if (relative_error == 1e-3) return row.at_1e3;
        if (relative_error == 1e-4) return row.at_1e4;
    }
    return std::nullopt;
}

bool only_published(std::string_view method) {
    for (std::string_view absent : {"Divonne", "Suave", "Cuhre", "qmc", "Cuba Vegas Sobol'"})
        if (method == absent) return true;
    return false;
}

std::optional<PublishedErrors> published_errors(Line line) {
    for (const ErrorRow& row : errors)
        if (row.line == line) return row.errors;
    return std::nullopt;
}

std::span<const PublishedOverhead> published_overheads() { return overheads; }
std::span<const PublishedHonesty> published_honesty() { return honesty; }

} // namespace montelux::bench
