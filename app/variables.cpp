#include "app/variables.h"

#include "app/usage_error.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>
#include <utility>

#include "montelux/mc/integrate/unit_points.h"

namespace montelux::app {
namespace {

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
    return begin == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin + 1));
}

// Where `c` stands outside brackets; npos where it does not.
std::size_t find_outside_brackets(const std::string& text, char c, std::size_t from = 0) {
    int depth = 0;
    for (std::size_t i = from; i < text.size(); ++i) {
        if (text[i] == '(') ++depth;
        if (text[i] == ')') --depth;
        if (text[i] == c && depth == 0) return i;
    }
    return std::string::npos;
}

// x1..x8
void add_numbered(const std::string& text, std::size_t dots, const std::string& option,
                  std::vector<std::string>& names) {
    const std::string first = trimmed(std::string_view(text).substr(0, dots));
    const std::string last = trimmed(std::string_view(text).substr(dots + 2));
    const std::size_t digits = first.find_last_not_of("0123456789") + 1;
    const std::string stem = first.substr(0, digits);
    auto number = [&](const std::string& name) -> std::optional<int> {
        if (!name.starts_with(stem) || name.size() == stem.size()) return std::nullopt;
        int value = 0;
        const char *from = name.data() + stem.size(), *end = name.data() + name.size();
        auto [stop, error] = std::from_chars(from, end, value);
        return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
    };
    const std::optional<int> a = number(first), b = number(last);
    constexpr int most = 100'000;
    if (!a || !b || *a > *b || *b - *a >= most)
        throw UsageError(option, "'" + text + "' is not a range of names; expected one such as x1..x8");
    for (int i = *a; i <= *b; ++i) names.push_back(stem + std::to_string(i));
}

std::vector<std::string> read_names(const std::string& text, const std::string& option) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string one = trimmed(std::string_view(text).substr(begin, end - begin));
        if (const std::size_t dots = one.find(".."); dots != std::string::npos)
            add_numbered(one, dots, option, names);
        else
            names.push_back(one);
        begin = end + 1;
    }
    for (const std::string& name : names) check_variable_name(name, option);
    return names;
}

Range read_range(const std::string& text, const std::string& option, const NamedConstants& given) {
    const std::size_t colon = find_outside_brackets(text, ':');
    if (colon == std::string::npos || find_outside_brackets(text, ':', colon + 1) != std::string::npos)
        throw UsageError(option, "'" + text + "' is not a range; expected LOWER:UPPER, for example 0:pi/2");
    const std::string ends[2] = {trimmed(std::string_view(text).substr(0, colon)),
                                 trimmed(std::string_view(text).substr(colon + 1))};
    double values[2];
    for (int i = 0; i < 2; ++i) {
        if (ends[i].empty())
            throw UsageError(option, std::string("the range has no ") + (i == 0 ? "lower" : "upper") +
                                         " end; expected LOWER:UPPER, for example 0:pi/2");
        values[i] = constant(ends[i], option, given);
        if (std::isnan(values[i]))
            throw UsageError(option, "the " + std::string(i == 0 ? "lower" : "upper") + " end '" + ends[i] +
                                         "' is not a number");
    }
    if (values[0] > values[1])
        throw UsageError(option, "the range is reversed; expected the lower end first (a minus sign before "
                                 "the integrand turns the direction)");
    if (values[0] == values[1]) throw UsageError(option, "the range is empty: both ends are equal");
    return {values[0], values[1]};
}

} // namespace

Variables read_variables(const std::vector<std::string>& over, bool boxes, const NamedConstants& given) {
    if (over.empty())
        throw UsageError("--over", boxes ? "no variable is given; expected one --over NAME=LOWER:UPPER a "
                                           "variable, for example --over x=0:pi/2"
                                         : "no variable is given; expected --over NAMES, for example --over "
                                           "x,y,z");
    Variables variables;
    for (const std::string& text : over) {
        const std::string option = "--over '" + text + "'";
        const std::size_t equal = text.find('=');
        if (boxes && equal == std::string::npos)
            throw UsageError(option, "no range is given; expected NAME=LOWER:UPPER, for example x=0:pi/2");
        if (!boxes && equal != std::string::npos)
            throw UsageError(option, "only a box has ranges; expected NAMES alone, for example x,y,z");
        const std::vector<std::string> names = read_names(text.substr(0, equal), option);
        for (const std::string& name : names) {
            if (std::find(variables.names.begin(), variables.names.end(), name) != variables.names.end())
                throw UsageError(option, "the variable '" + name + "' is given twice");
            for (const NamedConstant& c : given)
                if (c.name == name)
                    throw UsageError(option,
                                     "'" + name + "' is a constant of --let; a variable needs another name");
            variables.names.push_back(name);
        }
        if (boxes)
            variables.ranges.resize(variables.names.size(),
                                    read_range(text.substr(equal + 1), option, given));
    }
    return variables;
}

NamedConstants read_constants(const std::vector<std::string>& let) {
    NamedConstants constants;
    for (const std::string& text : let) {
        const std::string option = "--let '" + text + "'";
        const std::size_t equal = text.find('=');
        if (equal == std::string::npos)
            throw UsageError(option, "no value is given; expected NAME=VALUE, for example s=0.1");
        const std::string name = trimmed(std::string_view(text).substr(0, equal));
        check_variable_name(name, option);
        for (const NamedConstant& c : constants)
            if (c.name == name) throw UsageError(option, "the constant '" + name + "' is given twice");
        const std::string formula = text.substr(equal + 1);
        const double value = constant(formula, option, constants);
        if (std::isnan(value)) throw UsageError(option, "the value '" + formula + "' is not a number");
        constants.push_back({name, value, formula});
    }
    return constants;
}

void read_densities(const std::vector<std::string>& densities, Variables& variables,
                    const NamedConstants& given) {
    for (const std::string& text : densities) {
        const std::string option = "--density '" + text + "'";
        const std::size_t equal = text.find('=');
        const bool named = equal != std::string::npos && equal + 1 < text.size() && text[equal + 1] != '=' &&
                           equal > 0 &&
                           std::string_view("<>!").find(text[equal - 1]) == std::string_view::npos;
        if (!named && variables.names.size() != 1)
            throw UsageError(option, "expected NAME=FORMULA, the name being that of one of the variables");
        const std::string name =
            named ? trimmed(std::string_view(text).substr(0, equal)) : variables.names[0];
        auto at = std::find(variables.names.begin(), variables.names.end(), name);
        if (at == variables.names.end())
            throw UsageError(option, "there is no variable '" + name + "'; --over gives it a range");
        const auto d = static_cast<std::size_t>(at - variables.names.begin());
        variables.densities.resize(variables.names.size());
        if (variables.densities[d])
            throw UsageError(option, "the variable '" + name + "' has a density already");
        const Formulas formula({named ? text.substr(equal + 1) : text}, {name}, "--density " + name, given);
        const Range range = variables.ranges[d];
        try {
            variables.densities[d] = Distribution::from_density([formula](double x) { return formula(x); },
                                                                range.lower, range.upper);
        } catch (const UsageError&) {
            throw;
        } catch (const Error& error) {
            throw Error(option, error.what());
        }
    }
}

Domain box_domain(const Variables& variables) {
    Domain box(variables.ranges);
    if (variables.densities.empty()) return box;
    const int dimensions = static_cast<int>(variables.names.size());
    std::vector<Domain> intervals;
    std::string description = box.description() + " by density";
    for (const Range& range : variables.ranges) intervals.push_back(Domain({range}));
    auto map = [intervals, densities = variables.densities](const PointBatch& u, PointBuffer& x,
                                                            std::span<double> volume) {
        PointBuffer one(u.count(), 1);
        for (int d = 0; d < u.dimensions(); ++d) {
            const auto& density = densities[static_cast<std::size_t>(d)];
            std::span<double> out = x.coordinate(d);
            if (density) {
                density->sample(u.coordinate(d), out);
                std::span<double> p = one.coordinate(0);
                density->pdf(out, p);
                for (std::size_t i = 0; i < p.size(); ++i) volume[i] /= p[i];
            } else {
                const PointBatch from(u.coordinate(d).data(), u.count(), 1, u.stride());
                intervals[static_cast<std::size_t>(d)].map(from, one, volume);
                std::copy_n(one.coordinate(0).data(), u.count(), out.data());
            }
        }
    };
    return Domain::mapped_batch(dimensions, dimensions, std::move(map), std::move(description));
}

void check_densities(const Variables& variables, const NamedIntegrand& integrand, bool logarithm) {
    if (variables.densities.empty()) return;
    constexpr std::size_t points = 4096;
    const int dimensions = static_cast<int>(variables.names.size());
    PointBuffer u(points, dimensions), x(points, dimensions);
    fill_random(u, 0, 0, 0);
    std::vector<double> volume(points, 1.0);
    Domain(variables.ranges).map(u, x, volume);
    ValueBuffer values(points, integrand.count());
    integrand.function(x, values);
    if (logarithm) {
        std::span<double> logs = values.component(0);
        double largest = -std::numeric_limits<double>::infinity();
        for (double v : logs)
            if (std::isfinite(v)) largest = std::max(largest, v);
        for (double& v : logs) v = std::exp(v - largest); // NaN where all are -infinity
    }
    std::vector<double> everywhere(static_cast<std::size_t>(integrand.count())), missed(everywhere);
    std::vector<std::size_t> where(everywhere.size());
    for (std::size_t i = 0; i < points; ++i) {
        bool zero = false;
        for (int d = 0; d < dimensions; ++d)
            if (const auto& density = variables.densities[static_cast<std::size_t>(d)])
                zero = zero || !(density->pdf(x(i, d)) > 0);
        for (std::size_t c = 0; c < everywhere.size(); ++c) {
            const double share = std::abs(values(i, static_cast<int>(c))) * volume[i];
            if (!std::isfinite(share)) continue;
            everywhere[c] += share;
            if (!zero) continue;
            if (missed[c] == 0) where[c] = i;
            missed[c] += share;
        }
    }
    for (std::size_t c = 0; c < everywhere.size(); ++c) {
        // Far out both may underflow, one before the other; that costs nothing.
        if (!(missed[c] > 1e-9 * everywhere[c])) continue;
        std::string point;
        for (int d = 0; d < dimensions && d < 8; ++d) {
            char text[64];
            std::snprintf(text, sizeof text, "%s%s = %.6g", d ? ", " : "",
                          variables.names[static_cast<std::size_t>(d)].c_str(), x(where[c], d));
            point += text;
        }
        throw Error("--density", "the density is zero where '" + integrand.names[c] +
                                     "' is not, for example at " + point +
                                     "; that part of the integral would be missed");
    }
}

} // namespace montelux::app
