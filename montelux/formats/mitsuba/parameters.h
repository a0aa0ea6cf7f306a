// Parameters: the values of `$name` in the attributes of Mitsuba's XML.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/xml_values.h"

namespace montelux::mitsuba {

class Parameters {
  public:
    // `given`: those of the user, by name without '$'.
    explicit Parameters(std::map<std::string, std::string> given) : values_(std::move(given)) {
        for (const auto& [name, value] : values_) given_.insert(name);
    }

    // <default>: has no effect where the name has a value.
    void set_default(const std::string& name, const std::string& value) { values_.try_emplace(name, value); }
    // The text with each `$name` replaced; the longest name that fits is meant. "\$" is a dollar sign. An Error for
    // names without a value, and for texts that grow beyond a mebibyte.
    std::string substituted(std::string_view text, const Place& place);

    // Names that the user gave and nothing uses, each quoted.
    std::vector<std::string> unused() const;
    // Those with a value.
    std::vector<std::string_view> names() const;

  private:
    std::map<std::string, std::string> values_;
    std::set<std::string> given_, used_;
};

} // namespace montelux::mitsuba
