#include "montelux/mc/integrate/method.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/grid/grid.h"
#include "montelux/mc/integrate/metropolis/metropolis.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/stratified/recursive.h"
#include "montelux/mc/integrate/stratified/stratified.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// The methods that are complete without arguments.
using Make = Method (*)();
template <MethodSettings S>
Method make() {
    return S{};
}
struct Entry {
    std::string_view name;
    Make make;
};
template <MethodSettings S>
constexpr Entry entry() {
    return {S::name, make<S>};
}
constexpr std::array entries{
    entry<Auto>(),       entry<Adaptive>(),        entry<Vegas>(),        entry<VegasSobol>(),
    entry<Quasi>(),      entry<BasicMonteCarlo>(), entry<Stratified>(),   entry<Recursive>(),
    entry<Metropolis>(), entry<RiemannSum>(),      entry<MidpointRule>(), entry<TrapezoidRule>(),
    entry<Cubature>(),
};
constexpr auto method_names = [] {
    std::array<std::string_view, entries.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = entries[i].name;
    return names;
}();

} // namespace

Method::Method() : Method(Auto{}) {}

Method Method::named(std::string_view name) {
    for (const Entry& e : entries)
        if (e.name == name) return e.make();
    std::string what = "there is no method '" + std::string(name) + "'; expected one of";
    for (std::string_view known : method_names)
        what += (known == method_names.front() ? " " : ", ") + std::string(known);
    throw Error("method", what);
}

std::span<const std::string_view> Method::names() { return method_names; }

std::string Method::device_names() {
    std::vector<std::string_view> able;
    std::ranges::copy_if(method_names, std::back_inserter(able),
                         [](std::string_view name) { return named(name).on_device(); });
    std::string text;
    for (std::size_t i = 0; i < able.size(); ++i)
        text += (i == 0 ? "" : i + 1 == able.size() ? " or " : ", ") + std::string(able[i]);
    return text;
}

std::unique_ptr<Estimator> Method::estimator(const Problem& problem) const {
    if (!on_device_ && problem.evaluator.integrand().on_device().function)
        throw Error("integrate",
                    "the method '" + name_ + "' does not run on a device; expected " + device_names());
    return make_(problem);
}

} // namespace montelux
