// Formulas that a user types: parsed once, evaluated from any thread.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/integrand.h"

namespace montelux::app {

// A name that stands for a number in formulas.
struct NamedConstant {
    std::string name;
    double value = 0;
    std::string text; // its formula, in which constants before it may stand
};
using NamedConstants = std::vector<NamedConstant>; // in the order in which they were given

// Formulas in the same variables; each is one component of a function of a point. Known besides the
// variables and the given constants: + - * / ^, comparisons, && ||, c ? a : b, the constants pi, e, inf and nan, and the functions
// that formula_functions() lists. Evaluation may run on many threads at once: a parser of muParser belongs
// to one thread at a time (its variables are places in memory), so each call borrows one from a pool.
class Formulas {
  public:
    // `option` says in errors where the texts come from ("" for the command's argument). Throws UsageError
    // with the place, marked by a caret, of what cannot be read, and with the nearest known name.
    Formulas(const std::vector<std::string>& texts, const std::vector<std::string>& variables,
             const std::string& option, const NamedConstants& given = {});

    int count() const;
    const std::vector<std::string>& texts() const;
    // Points near which the formulas may have features (formula_landmarks).
    std::vector<std::vector<double>> landmarks() const;
    // Functions that are zero near such points (formula_guides).
    std::vector<Integrand::BatchFunction> guides() const;
    // Two values per formula with random roundings, of constants too (Integrand::with_rounding).
    Integrand::BatchFunction rounding() const;
    // Coordinate d of a point is the value of variable d.
    void operator()(const PointBatch& x, ValueBatch y) const;
    // The value of the first formula; one variable.
    double operator()(double x) const;

  private:
    struct Pool;
    std::shared_ptr<Pool> pool_;
};

// A number that may be written as a formula without variables: "pi/2", "-inf", "1e-4", or with constants.
double constant(const std::string& text, const std::string& option, const NamedConstants& given = {});

// A name that formulas may use for a variable; throws UsageError where it is none.
void check_variable_name(const std::string& name, const std::string& option);

// "sin, cos, ...": for the help.
std::string formula_functions();

} // namespace montelux::app
