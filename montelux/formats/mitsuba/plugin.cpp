#include "montelux/formats/mitsuba/plugin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/formats/mitsuba/coverage.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

std::string short_number(double value) {
    std::string text = std::to_string(value);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.ends_with('.')) text.pop_back();
    }
    return text;
}

} // namespace

std::string_view type_name(const PropertyValue& value) {
    return std::visit(Overloaded{[](bool) { return std::string_view("true or false"); },
                                 [](std::int64_t) { return std::string_view("an integer"); },
                                 [](double) { return std::string_view("a number"); },
                                 [](const std::string&) { return std::string_view("a text"); },
                                 [](const Vec3d&) { return std::string_view("a vector"); },
                                 [](const RgbValue&) { return std::string_view("a colour"); },
                                 [](const SpectrumValue&) { return std::string_view("a spectrum"); },
                                 [](const Matrix4&) { return std::string_view("a transformation"); },
                                 [](ObjectIndex) { return std::string_view("an object"); }},
                      value);
}

std::string Plugin::describe() const { return "the " + kind() + " " + in_quotes(type()); }

void Plugin::refuse() const {
    if (const PluginCoverage* known = find_plugin(kind(), type()))
        error(describe() + " is not supported" +
              (known->note.empty() ? std::string() : ": " + std::string(known->note)));
    const std::vector<std::string_view> names = plugin_names(kind());
    error("there is no " + kind() + " " + in_quotes(type()) + did_you_mean(type(), names));
}

const Property* Plugin::look_up(std::string_view name) const {
    const std::vector<Property>& all = object().properties;
    const auto found = std::ranges::find(all, name, &Property::name);
    return found == all.end() ? nullptr : &*found;
}

void Plugin::wrong_type(const Property& property, std::string_view expected) const {
    graph_->diagnostics.error(property.at, in_quotes(property.name) + " is " +
                                               std::string(type_name(property.value)) + "; expected " +
                                               std::string(expected));
}

bool Plugin::has(std::string_view name) const { return look_up(name) != nullptr; }

const Property* Plugin::find(std::string_view name) {
    asked_.emplace_back(name);
    const Property* property = look_up(name);
    if (property != nullptr) used_[static_cast<std::size_t>(property - object().properties.data())] = true;
    return property;
}

bool Plugin::flag(std::string_view name, bool otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    if (const auto* value = std::get_if<bool>(&property->value)) return *value;
    wrong_type(*property, "true or false");
}

std::int64_t Plugin::integer(std::string_view name, std::int64_t otherwise, std::int64_t least,
                             std::int64_t most) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    const auto* value = std::get_if<std::int64_t>(&property->value);
    if (value == nullptr) wrong_type(*property, "an integer");
    if (*value < least || *value > most)
        graph_->diagnostics.error(property->at, in_quotes(name) + " is " + std::to_string(*value) +
                                                    "; expected an integer from " + std::to_string(least) +
                                                    " to " + std::to_string(most));
    return *value;
}

double Plugin::number(std::string_view name, double otherwise, double least, double most) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    double value = 0;
    if (const auto* number = std::get_if<double>(&property->value))
        value = *number;
    else if (const auto* integer = std::get_if<std::int64_t>(&property->value))
        value = static_cast<double>(*integer);
    else
        wrong_type(*property, "a number");
    if (!(value >= least && value <= most)) {
        std::string range = " from " + short_number(least) + " to " + short_number(most);
        if (most == std::numeric_limits<double>::max()) range = " of at least " + short_number(least);
        if (least == -std::numeric_limits<double>::max()) range = " of at most " + short_number(most);
        graph_->diagnostics.error(property->at, in_quotes(name) + " is " + short_number(value) +
                                                    "; expected a number" + range);
    }
    return value;
}

std::string Plugin::text(std::string_view name, std::string_view otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return std::string(otherwise);
    if (const auto* value = std::get_if<std::string>(&property->value)) return *value;
    wrong_type(*property, "a text");
}

std::string Plugin::choice(std::string_view name, std::string_view otherwise,
                           std::initializer_list<std::string_view> names) {
    std::string value = text(name, otherwise);
    if (std::ranges::find(names, value) == names.end()) {
        std::string all;
        for (const std::string_view n : names) all += (all.empty() ? "" : ", ") + std::string(n);
        graph_->diagnostics.error(look_up(name)->at,
                                  in_quotes(name) + " is " + in_quotes(value) + "; expected one of " + all);
    }
    return value;
}

Vec3d Plugin::vector(std::string_view name, Vec3d otherwise) {
    const Property* property = find(name);
    if (property == nullptr) return otherwise;
    if (const auto* value = std::get_if<Vec3d>(&property->value)) return *value;
    wrong_type(*property, "a vector");
}

Transform Plugin::transform(std::string_view name) {
    const Property* property = find(name);
    if (property == nullptr) return {};
    const auto* matrix = std::get_if<Matrix4>(&property->value);
    if (matrix == nullptr) wrong_type(*property, "a transformation");
    const std::optional<Transform> transform = Transform::from_matrix(*matrix);
    if (!transform)
        graph_->diagnostics.error(property->at, "the transformation " + in_quotes(name) + " has no inverse");
    return *transform;
}

std::filesystem::path Plugin::file(std::string_view name) {
    const std::string value = text(name, "");
    if (!has(name)) error(describe() + " needs the property " + in_quotes(name));
    return graph_->files.find(value, look_up(name)->at);
}

std::vector<Plugin> Plugin::children(std::string_view kind) {
    std::vector<Plugin> all;
    const std::vector<Property>& properties = object().properties;
    for (std::size_t i = 0; i < properties.size(); ++i) {
        const auto* child = std::get_if<ObjectIndex>(&properties[i].value);
        if (child == nullptr || graph_->objects[child->value].kind != kind) continue;
        used_[i] = true;
        all.emplace_back(*graph_, child->value);
    }
    return all;
}

std::optional<Plugin> Plugin::child(std::string_view kind) {
    std::vector<Plugin> all = children(kind);
    if (all.size() > 1)
        all[1].error(describe() + " has several objects of the kind '" + std::string(kind) +
                     "'; expected one");
    return all.empty() ? std::nullopt : std::optional(std::move(all[0]));
}

std::optional<Plugin> Plugin::object(std::string_view name) {
    const Property* property = find(name);
    const auto* child = property == nullptr ? nullptr : std::get_if<ObjectIndex>(&property->value);
    return child == nullptr ? std::nullopt : std::optional(Plugin(*graph_, child->value));
}

void Plugin::ignore(std::string_view name, std::string_view why) {
    if (const Property* property = find(name))
        graph_->diagnostics.warn_once(kind() + "." + type() + "." + std::string(name), property->at,
                                      in_quotes(name) + " is ignored: " + std::string(why));
}

void Plugin::finish() {
    const std::vector<Property>& properties = object().properties;
    const std::vector<std::string_view> names(asked_.begin(), asked_.end());
    for (std::size_t i = 0; i < properties.size(); ++i) {
        if (used_[i]) continue;
        used_[i] = true;
        const Property& p = properties[i];
        std::string what = describe() + " has no property " + in_quotes(p.name) + did_you_mean(p.name, names);
        if (const auto* child = std::get_if<ObjectIndex>(&p.value))
            what = describe() + " has no use for " + Plugin(*graph_, child->value).describe();
        graph_->diagnostics.warn(p.at, what);
    }
}

} // namespace montelux::mitsuba
