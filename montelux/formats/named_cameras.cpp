#include "montelux/formats/named_cameras.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>
#include <vector>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {

std::optional<std::size_t> find_camera(std::span<const std::string> names, const std::string& asked) {
    const auto named = std::ranges::find(names, asked);
    if (named != names.end()) return static_cast<std::size_t>(named - names.begin());
    std::size_t number = 0;
    const char* const last = asked.data() + asked.size();
    const auto [end, error] = std::from_chars(asked.data(), last, number);
    if (error == std::errc() && end == last && number < names.size()) return number;
    return std::nullopt;
}

std::string numbered_names(std::span<const std::string> names) {
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i)
        list +=
            (i == 0 ? "" : ", ") + std::to_string(i) + (names[i].empty() ? "" : " " + in_quotes(names[i]));
    return list;
}

std::string no_such_camera(std::span<const std::string> names, const std::string& asked) {
    const std::vector<std::string_view> known(names.begin(), names.end());
    return "there is no camera " + in_quotes(asked) + did_you_mean(asked, known) +
           (names.empty() ? "; the scene has none" : "; expected " + numbered_names(names));
}

} // namespace montelux
