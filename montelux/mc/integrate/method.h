// A method of integration: the settings of any estimator, as one value.
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// Settings of an estimator: plain values with a name, and the estimator for a problem. `estimator` throws
// Error where the method cannot do the problem (too many dimensions, settings out of range).
template <typename S>
concept MethodSettings = std::copyable<S> && requires(const S& settings, const Problem& problem) {
    { S::name } -> std::convertible_to<std::string_view>;
    { settings.estimator(problem) } -> std::convertible_to<std::unique_ptr<Estimator>>;
};

class Method {
  public:
    // Auto.
    Method();
    template <typename S>
    requires(!std::same_as<S, Method> && MethodSettings<S>) // not the copy constructor
        Method(S settings)
        : name_(S::name), on_device_(draws_on_device<S>()), first_look_(look_of<S>()),
          make_([settings](const Problem& problem) { return settings.estimator(problem); }) {}

    // A method by name with its default settings; throws Error that lists the names.
    static Method named(std::string_view name);
    // The names that `named` knows.
    static std::span<const std::string_view> names();
    // Of those whose points can be drawn on a device, for messages: "a, b or c".
    static std::string device_names();

    const std::string& name() const { return name_; }
    // Can its points be drawn on a device?
    bool on_device() const { return on_device_; }
    FirstLookUse first_look() const { return first_look_; }
    // Throws Error where the integrand is on a device and the method does not run there.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;

  private:
    template <typename S>
    static constexpr bool draws_on_device() {
        if constexpr (requires { S::on_device; })
            return S::on_device;
        else
            return false;
    }

    template <typename S>
    static constexpr FirstLookUse look_of() {
        if constexpr (requires { S::first_look; })
            return S::first_look;
        else
            return FirstLookUse::never;
    }

    std::string name_;
    bool on_device_ = false;
    FirstLookUse first_look_ = FirstLookUse::never;
    std::function<std::unique_ptr<Estimator>(const Problem&)> make_;
};

} // namespace montelux
