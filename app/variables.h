// The variables of a formula with their ranges and densities, as typed: x=0:inf, x1..x8=0:1, x=exp(-x).
#pragma once

#include "app/expression.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux::app {

struct Variables {
    std::vector<std::string> names;
    std::vector<Range> ranges; // empty unless the domain is a box
    // Importance densities; empty where none is given for any variable, else one for each variable.
    std::vector<std::optional<Distribution>> densities;
};

// From the values of --over: NAMES=LOWER:UPPER (or NAMES alone where `boxes` is false), NAMES being x or
// x,y or x1..x8. Ends of ranges may contain the given constants. Throws UsageError.
Variables read_variables(const std::vector<std::string>& over, bool boxes, const NamedConstants& given = {});

// Adds the values of --density: NAME=FORMULA in that variable alone, or FORMULA where there is one variable.
void read_densities(const std::vector<std::string>& densities, Variables& variables,
                    const NamedConstants& given = {});

// From the values of --let: NAME=VALUE, where VALUE may contain the names before it. Throws UsageError.
NamedConstants read_constants(const std::vector<std::string>& let);

// The box of the ranges; variables with a density are mapped by its quantile, with the volume factor
// 1 / density, so that uniform numbers become samples of the density for every method.
Domain box_domain(const Variables& variables);

// Components of an integrand, and how reports call them.
struct NamedIntegrand {
    Integrand::BatchFunction function;
    std::vector<std::string> names;
    std::shared_ptr<const DeviceFunction> compiled = nullptr; // on a device; null: there is none
    std::vector<std::vector<double>> landmarks = {};          // of the formulas (formula_landmarks),
    std::vector<Integrand::BatchFunction> guides = {};        // (formula_guides),
    Integrand::BatchFunction rounding = {};                   // (Formulas::rounding)

    int count() const { return static_cast<int>(names.size()); }
    // An integrand with another function, such as this one's on several machines.
    Integrand integrand(Integrand::BatchFunction f) const {
        return hinted(Integrand::batch(std::move(f), count()));
    }
    // With the landmarks, the guides and the rounding.
    Integrand hinted(const Integrand& f) const {
        return f.with_landmarks(landmarks).with_guides(guides).with_rounding(rounding);
    }
};

// Throws Error where a density is zero and the integrand is not, since the integral would then be silently
// wrong. Checks 4096 points. `logarithm`: the integrand is log f.
void check_densities(const Variables& variables, const NamedIntegrand& integrand, bool logarithm);

} // namespace montelux::app
