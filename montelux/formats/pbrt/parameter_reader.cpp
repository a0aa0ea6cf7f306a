#include "montelux/formats/pbrt/parameter_reader.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "montelux/mc/math/nearest_name.h"

namespace montelux::pbrt {

ParameterReader::ParameterReader(const ParameterList& list, std::string plugin, Location at,
                                 Diagnostics& diagnostics)
    : list_(list), plugin_(std::move(plugin)), at_(at), diagnostics_(diagnostics) {}

void ParameterReader::know(std::string_view name) {
    // Otherwise an Attribute that sets it would be reported as an error.
    assert((!list_.kind() || has_parameter(*list_.kind(), name)) && "to be added to plugin_parameters.cpp");
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
}

Location ParameterReader::at(std::string_view name) const {
    const Parameter* p = list_.find(name);
    return p ? p->at : at_;
}

const Parameter* ParameterReader::any(std::string_view name, std::initializer_list<ParameterType> types) {
    know(name);
    const Parameter* last = nullptr;
    for (const Parameter& p : list_.own()) {
        if (p.name != name) continue;
        if (std::find(types.begin(), types.end(), p.type) == types.end()) wrong_type(p, types);
        // Repetitions of one type are reported where the parameters are parsed.
        if (last && last->type != p.type)
            diagnostics_.warn(p.at, "parameter " + in_quotes(name) + " is given as " +
                                        std::string(name_of(last->type)) + " and as " +
                                        std::string(name_of(p.type)) + "; the last one counts");
        last = &p;
    }
    if (last) return last;
    if (const Parameter* p = list_.find_default(name, types)) return p;
    if (const Parameter* other = list_.find(name)) wrong_type(*other, types);
    return nullptr;
}

void ParameterReader::wrong_type(const Parameter& p, std::span<const ParameterType> types) const {
    std::string expected;
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (i > 0) expected += i + 1 == types.size() ? " or " : ", ";
        expected += name_of(types[i]);
    }
    diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + " has type " + std::string(name_of(p.type)) +
                                 "; expected " + expected);
}

const Parameter* ParameterReader::ignored(std::string_view name) {
    know(name);
    return list_.find(name);
}

void ParameterReader::check_count(const Parameter& p, std::size_t count) const {
    if (p.value_count() != count)
        diagnostics_.error(
            p.at, "parameter " + in_quotes(p.name) + " has " + std::to_string(p.value_count()) +
                      (p.value_count() == 1 ? " value" : " values") + "; expected " + std::to_string(count));
}

const Parameter* ParameterReader::one(std::string_view name, ParameterType type, std::size_t count) {
    const Parameter* p = any(name, {type});
    if (p) check_count(*p, count);
    return p;
}

float ParameterReader::number_of(const Parameter& p) const {
    check_count(p, 1);
    return p.numbers[0];
}

std::optional<float> ParameterReader::number(std::string_view name) {
    const Parameter* p = one(name, ParameterType::floating);
    return p ? std::optional(p->numbers[0]) : std::nullopt;
}

std::optional<int> ParameterReader::integer(std::string_view name) {
    const Parameter* p = one(name, ParameterType::integer);
    return p ? std::optional<int>(p->integers[0]) : std::nullopt;
}

std::optional<bool> ParameterReader::boolean(std::string_view name) {
    const Parameter* p = one(name, ParameterType::boolean);
    return p ? std::optional(p->integers[0] != 0) : std::nullopt;
}

std::optional<std::string> ParameterReader::string(std::string_view name) {
    const Parameter* p = one(name, ParameterType::string);
    return p ? std::optional(p->strings[0]) : std::nullopt;
}

std::optional<Vec3f> ParameterReader::triple(std::string_view name, ParameterType type) {
    const Parameter* p = one(name, type, 3);
    return p ? std::optional(Vec3f(p->numbers[0], p->numbers[1], p->numbers[2])) : std::nullopt;
}

std::span<const float> ParameterReader::numbers(std::string_view name, ParameterType type,
                                                std::size_t group) {
    const Parameter* p = any(name, {type});
    if (!p) return {};
    if (p->numbers.size() % group != 0)
        diagnostics_.error(p->at, "parameter " + in_quotes(name) + " has " +
                                      std::to_string(p->numbers.size()) +
                                      " numbers; expected a multiple of " + std::to_string(group));
    return p->numbers;
}

std::vector<Vec3f> ParameterReader::triples(std::string_view name, ParameterType type) {
    const std::span<const float> values = numbers(name, type, 3);
    std::vector<Vec3f> v;
    v.reserve(values.size() / 3 + 1); // so that Embree can read positions in place
    v.resize(values.size() / 3);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return v;
}

std::span<const std::int32_t> ParameterReader::integers(std::string_view name) {
    const Parameter* p = any(name, {ParameterType::integer});
    return p ? std::span<const std::int32_t>(p->integers) : std::span<const std::int32_t>();
}

std::string_view ParameterReader::choice(std::string_view name,
                                         std::initializer_list<std::string_view> choices,
                                         std::string_view otherwise) {
    const Parameter* p = one(name, ParameterType::string);
    if (!p) return otherwise;
    std::string expected;
    for (std::string_view c : choices) {
        if (p->strings[0] == c) return c;
        expected += (expected.empty() ? "" : ", ") + std::string(c);
    }
    diagnostics_.error(p->at, "parameter " + in_quotes(name) + " is " + in_quotes(p->strings[0]) +
                                  "; expected one of " + expected +
                                  did_you_mean(p->strings[0], {choices.begin(), choices.size()}));
}

void ParameterReader::finish() {
    for (const Parameter& p : list_.own()) {
        if (std::find(known_.begin(), known_.end(), p.name) != known_.end()) continue;
        diagnostics_.warn_once(plugin_ + "/" + p.name, p.at,
                               plugin_ + " has no parameter " + in_quotes(p.name) +
                                   did_you_mean(p.name, known_) + "; it is ignored");
    }
}

} // namespace montelux::pbrt
