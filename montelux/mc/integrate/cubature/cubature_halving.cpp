#include "montelux/mc/integrate/cubature/cubature_halving.h"

#include <algorithm>
#include <cmath>

namespace montelux {
namespace {

constexpr std::uint64_t points_per_step = 1'000'000;
// Factor on the errors of one variable's seven points, which are otherwise trusted too early.
constexpr double caution_with_few_points = 16;

} // namespace

std::vector<std::size_t> regions_to_halve(const CubatureRegions& regions, std::span<const double> scale,
                                          bool search) {
    const std::size_t count = regions.count();
    std::vector<double> key(count, 0.0);
    std::vector<std::size_t> order;
    for (std::size_t r = 0; r < count; ++r) {
        const CubatureRegions::Marks& marks = regions.marks(r);
        if (marks.indivisible) continue;
        if (search) {
            key[r] = regions.volume(r);
        } else if (!marks.exhausted) {
            for (std::size_t c = 0; c < scale.size(); ++c)
                if (scale[c] > 0) key[r] = std::max(key[r], regions.error(r)[c] / scale[c]);
        }
        if (key[r] > 0) order.push_back(r);
    }
    const std::size_t most = std::min(order.size(), std::max<std::size_t>(1, count / 16));
    const std::size_t least = std::max<std::size_t>(1, count / 64);
    auto worse = [&](std::size_t a, std::size_t b) { return key[a] != key[b] ? key[a] > key[b] : a < b; };
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(), worse);
    order.resize(most);
    while (order.size() > least && key[order.back()] < key[order.front()] / 4) order.pop_back();
    return order;
}

void fit_evaluations(std::vector<const SymmetricRule*>& rules, std::vector<std::size_t>& parents,
                     std::uint64_t max_evaluations) {
    const std::size_t group = parents.empty() ? 1 : 2;
    std::uint64_t sum = 0;
    std::size_t kept = 0;
    for (; kept < rules.size(); kept += group) {
        sum += group * rules[kept]->points();
        if (sum > max_evaluations || (kept > 0 && sum > points_per_step)) break;
    }
    rules.resize(kept);
    if (!parents.empty()) parents.resize(kept / 2);
}

void correct_cube(const CubatureRegions& before, CubatureRegions& fresh) {
    const bool one_variable = fresh.centre(0).size() == 1;
    for (std::size_t c = 0; c < fresh.error(0).size(); ++c) {
        double& error = fresh.error(0)[c];
        if (before.empty()) {
            if (one_variable) error *= caution_with_few_points;
            continue;
        }
        // The difference of two rules is a better estimate than the null rules of one box.
        const double difference = std::abs(before.value(0)[c] - fresh.value(0)[c]);
        const double coarse = before.error(0)[c] / caution_with_few_points;
        if (!one_variable)
            error += difference / 32;
        else if (coarse > 0)
            error *=
                std::clamp(2 * difference / coarse, 0.125, caution_of_one_region) / caution_of_one_region;
    }
}

void add_face_errors(const CubatureWork& work) {
    const CubatureRegions& regions = work.regions;
    const std::size_t components = work.fresh.empty() ? 0 : work.fresh.value(0).size();
    for (std::size_t r = 0; r < work.fresh.count(); ++r) {
        const std::size_t parent = work.parents[r / 2];
        const CubatureRegions::Marks& from = regions.marks(parent);
        CubatureRegions::Marks& marks = work.fresh.marks(r);
        const bool upper_half = r % 2 == 1;
        const bool keeps_face = from.face_axis != from.axis || from.face_upper == upper_half;
        const double volume = work.fresh.volume(r);
        double largest_inherited = 0, largest_new = 0;
        bool decides = false;
        for (std::size_t c = 0; c < components; ++c) {
            const SymmetricRule::FaceValue &own = work.faces[r * components + c],
                                           &other = work.faces[(r ^ 1) * components + c];
            // Subtracts slope and curvature, which are not jumps.
            const double expected =
                2 * (own.slack + other.slack) + 0.25 * std::max(std::abs(own.value), std::abs(other.value));
            const double jump = std::max(0.0, std::abs(own.value - other.value) - expected);
            const double inherited = keeps_face ? regions.face_error(parent)[c] / 2 : 0;
            const double added = volume * own.unseen * jump;
            double& error = work.fresh.error(r)[c];
            decides = decides || inherited + added > error;
            work.fresh.face_error(r)[c] = inherited + added;
            error += inherited + added;
            largest_inherited = std::max(largest_inherited, inherited);
            largest_new = std::max(largest_new, added);
        }
        const bool shared = largest_new >= largest_inherited;
        marks.face_axis = shared ? from.axis : from.face_axis;
        marks.face_upper = shared ? !upper_half : from.face_upper;
        if (decides) {
            marks.axis = marks.face_axis;
            marks.exhausted = false;
        }
    }
}

} // namespace montelux
