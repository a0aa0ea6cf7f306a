#include "montelux/view/view_access.h"

#include <algorithm>
#include <random>

namespace montelux {

std::string ViewAccess::new_token() {
    static constexpr char digits[] = "0123456789abcdef";
    std::random_device device;
    std::string token;
    for (int word = 0; word < 4; ++word) {
        unsigned bits = device();
        for (int i = 0; i < 8; ++i, bits >>= 4) token += digits[bits & 15u];
    }
    return token;
}

bool ViewAccess::knows_token(std::string_view given) const {
    if (given.size() != token_.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < token_.size(); ++i)
        difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token_[i]);
    return difference == 0;
}

bool is_own_host(std::string_view host, std::string_view address, std::uint16_t port, bool is_loopback) {
    const std::string at = ":" + std::to_string(port);
    if (host.ends_with(at))
        host.remove_suffix(at.size());
    else if (port != 80)
        return false;
    const bool is_ipv6 = address.find(':') != std::string_view::npos;
    const std::string own = is_ipv6 ? "[" + std::string(address) + "]" : std::string(address);
    return host == own || (is_loopback && host == "localhost");
}

bool is_own_origin(std::string_view origin, std::string_view host) {
    constexpr std::string_view scheme = "http://";
    return origin.starts_with(scheme) && origin.substr(scheme.size()) == host;
}

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view query_value(std::string_view target, std::string_view name) {
    const std::size_t begin = target.find('?');
    if (begin == std::string_view::npos) return {};
    std::string_view rest = target.substr(begin + 1);
    while (!rest.empty()) {
        const std::string_view pair = rest.substr(0, rest.find('&'));
        if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
            return pair.substr(name.size() + 1);
        rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    }
    return {};
}

} // namespace montelux
