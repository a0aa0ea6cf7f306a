#include "montelux/scene/build/name_table.h"

#include <string_view>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {

void NameTable::declare(const std::string& name, Index index, SourceLocation at,
                        const BuildMessages& messages) {
    if (!declared_.emplace(name, index).second)
        messages.error(at, what_ + " " + quoted(name) + " is defined twice");
}

Index NameTable::refer(const std::string& name) {
    const auto [entry, is_new] = reference_of_.emplace(name, static_cast<Index>(names_.size()));
    if (is_new) names_.push_back(name);
    return entry->second;
}

Index NameTable::resolve(Index reference, SourceLocation at, const BuildMessages& messages,
                         std::string_view by) const {
    constexpr std::size_t most_compared = 10000;
    const std::string& name = names_[reference];
    if (const auto found = declared_.find(name); found != declared_.end()) return found->second;
    std::vector<std::string_view> names;
    if (declared_.size() <= most_compared)
        for (const auto& entry : declared_) names.push_back(entry.first);
    messages.error(at, std::string(by) + what_ + " " + quoted(name) + " is not defined" +
                           did_you_mean(name, names));
}

} // namespace montelux
