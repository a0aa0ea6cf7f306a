// An integrand: a function of a number, of a point or of many points; scalar or vector-valued.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/points.h"

namespace montelux {

class DeviceFunction;

// Where an integrand is evaluated at points that a device draws, and what happens to its values besides.
struct OnDevice {
    std::shared_ptr<const DeviceFunction> function; // null: on no device
    // Called before a number of points is evaluated, and with values after it; may throw. Of a batch that a device sums
    // `after` gets the least and the greatest value first, and all if it changes these (DeviceValues::summarise_above).
    std::vector<std::function<void(std::size_t)>> before = {};
    std::vector<std::function<void(ValueBatch)>> after = {};
    std::size_t block = 1 << 20; // points that are evaluated at a time: enough to hide the start of a kernel
};

// A function in one of the forms that users write, called once per batch. Functions are called from several
// threads at once and must not depend on the order of calls. They may throw: the integration then ends with
// that exception.
class Integrand {
  public:
    using BatchFunction = std::function<void(const PointBatch&, ValueBatch)>;

    // From f(double) -> double, for one variable; or f(std::span<const double>) -> double, for any number.
    template <typename F>
    requires(!std::same_as<std::remove_cvref_t<F>, Integrand> &&
             (std::is_invocable_r_v<double, const std::decay_t<F>&, double> ||
              std::is_invocable_r_v<double, const std::decay_t<F>&, std::span<const double>>)) //
        Integrand(F&& f)
        : components_(1) {
        using Function = std::decay_t<F>; // a pointer for plain functions
        if constexpr (std::is_invocable_r_v<double, const Function&, double>) {
            dimensions_ = 1;
            function_ = [f = Function(std::forward<F>(f))](const PointBatch& x, ValueBatch y) {
                std::span<const double> in = x.coordinate(0);
                std::span<double> out = y.component(0);
                for (std::size_t i = 0; i < in.size(); ++i) out[i] = f(in[i]);
            };
        } else {
            function_ = [f = Function(std::forward<F>(f))](const PointBatch& x, ValueBatch y) {
                std::span<double> out = y.component(0);
                for_each_point(x, [&](std::size_t i, std::span<const double> point) { out[i] = f(point); });
            };
        }
    }

    // From f(std::span<const double> x, std::span<double> y), which fills y with `components` values.
    template <typename F>
    static Integrand vector_valued(int components, F f) {
        return Integrand(components, [components, f = std::move(f)](const PointBatch& x, ValueBatch y) {
            std::vector<double> values(static_cast<std::size_t>(components));
            for_each_point(x, [&](std::size_t i, std::span<const double> point) {
                f(point, std::span<double>(values));
                for (int c = 0; c < components; ++c) y(i, c) = values[static_cast<std::size_t>(c)];
            });
        });
    }

    // From f(const PointBatch& x, ValueBatch y), which fills y for all points at once.
    static Integrand batch(BatchFunction f, int components = 1) {
        return Integrand(components, std::move(f));
    }

    // From a function that a device compiled. Estimators that can have their points drawn there do so.
    static Integrand compiled(std::shared_ptr<const DeviceFunction> f);

    // Number of variables that the form fixes: 1 for f(double), 0 where any will do.
    int fixed_dimensions() const { return dimensions_; }
    int components() const { return components_; }

    void operator()(const PointBatch& x, ValueBatch y) const { function_(x, y); }

    // Another function of the same variables and components, on no device.
    Integrand with_function(BatchFunction f) const {
        Integrand other(components_, std::move(f));
        other.dimensions_ = dimensions_;
        other.landmarks_ = landmarks_;
        other.guides_ = guides_;
        other.rounding_ = rounding_;
        return other;
    }
    // Returns this integrand with landmarks: points near which it may have features, such as the numbers of a formula. Each
    // has a coordinate for every variable.
    Integrand with_landmarks(std::vector<std::vector<double>> landmarks) const {
        Integrand other = *this;
        other.landmarks_ = std::move(landmarks);
        return other;
    }
    std::span<const std::vector<double>> landmarks() const { return landmarks_; }
    // Returns this integrand with guides: functions of the same variables, with one component, that are zero where it
    // may have features, such as what stands in the brackets of a formula.
    Integrand with_guides(std::vector<BatchFunction> guides) const {
        Integrand other = *this;
        other.guides_ = std::move(guides);
        return other;
    }
    std::span<const BatchFunction> guides() const { return guides_; }
    // Returns this integrand with a rounding function, which fills in two values of component c, at 2 c and 2 c + 1, computed
    // with other roundings. Their differences from f estimate its rounding error, which becomes part of the integral's error.
    Integrand with_rounding(BatchFunction twice) const {
        Integrand other = *this;
        other.rounding_ = std::move(twice);
        return other;
    }
    // Empty where rounding errors are not known.
    const BatchFunction& rounding() const { return rounding_; }
    const OnDevice& on_device() const { return on_device_; }
    // The same integrand, evaluated in this way on a device.
    Integrand with_device(OnDevice device) const {
        Integrand other = *this;
        other.on_device_ = std::move(device);
        return other;
    }

  private:
    Integrand(int components, BatchFunction f) : function_(std::move(f)), components_(components) {}

    template <typename Visit>
    static void for_each_point(const PointBatch& x, const Visit& visit) {
        auto dimensions = static_cast<std::size_t>(x.dimensions());
        std::array<double, 16> small;
        std::vector<double> large(dimensions > small.size() ? dimensions : 0);
        double* point = large.empty() ? small.data() : large.data();
        for (std::size_t i = 0; i < x.count(); ++i) {
            x.gather(i, point);
            visit(i, std::span<const double>(point, dimensions));
        }
    }

    BatchFunction function_;
    OnDevice on_device_{};
    std::vector<std::vector<double>> landmarks_;
    std::vector<BatchFunction> guides_;
    BatchFunction rounding_;
    int dimensions_ = 0;
    int components_;
};

} // namespace montelux
