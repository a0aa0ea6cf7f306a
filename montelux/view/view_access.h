// ViewAccess: which requests the viewer answers. A page of another site, opened in the same browser, must learn nothing
// from it and start nothing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace montelux {

class ViewAccess {
  public:
    // `token`: what a request for anything but the page's own files must know.
    explicit ViewAccess(std::string token) : token_(std::move(token)) {}

    // 128 bits of the system's random numbers, in hexadecimal digits.
    static std::string new_token();
    const std::string& token() const { return token_; }

    // Takes the same time for all wrong tokens of one length.
    bool knows_token(std::string_view given) const;

  private:
    std::string token_;
};

// Whether `host`, of the Host header, is the address at which the request arrived, or "localhost" for a loopback one.
// A name that some server of names points here (DNS rebinding) is not. IPv6 addresses are in brackets in the header.
bool is_own_host(std::string_view host, std::string_view address, std::uint16_t port, bool is_loopback);
// Whether `origin`, of the Origin header, is a page of that host.
bool is_own_origin(std::string_view origin, std::string_view host);

// The value of a parameter of a target ("/live?token=abc"); empty without one. Values are taken as they stand: those
// that the viewer knows need no escapes.
std::string_view query_value(std::string_view target, std::string_view name);
// The part of a target before its parameters.
std::string_view path_of(std::string_view target);

} // namespace montelux
