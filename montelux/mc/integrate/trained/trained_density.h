// TrainedDensity: what an integration learned about its integrand, to draw samples from, keep and use again.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/trained/unit_density.h"

namespace montelux {

// A density p(x) on a domain, close to |f| / integral of |f| for the integrand f that trained it: x(u) of the
// domain, with u drawn from a density of the unit cube. IntegrationResult::density holds one.
//
//     auto trained = integrate(f, domain, Adaptive{}, {.evaluations = 200'000}).density;
//     trained->save("trained.mx");
class TrainedDensity {
  public:
    // Throws Error where the domain takes another number of uniform variables.
    TrainedDensity(std::shared_ptr<const UnitDensity> unit, Domain domain);

    const UnitDensity& unit() const { return *unit_; }
    const std::shared_ptr<const UnitDensity>& shared_unit() const { return unit_; }
    const Domain& domain() const { return domain_; }
    // Texts that are kept with the density under names, for example the formula of its integrand.
    const std::map<std::string, std::string>& notes() const { return notes_; }
    void set_notes(std::map<std::string, std::string> notes) { notes_ = std::move(notes); }

    // p at points of the domain, per unit of its volume; zero outside of it. It integrates to 1, less the
    // probability of draws outside of the domain. Throws Error where the domain is no box: other maps
    // have no inverse.
    void pdf(const PointBatch& x, std::span<double> density) const;
    double pdf(std::span<const double> x) const;

    // A checksummed file, which replaces the one there as a whole or not at all; what it replaces becomes
    // PATH.previous. Throws Error.
    void save(const std::string& path) const;
    // Reads it. Throws Error for a file that is missing, damaged, of another kind or version, or inconsistent;
    // memory is bounded by the size of the file. A density on something else than a box of ranges needs its
    // domain again, and is refused with another one.
    static TrainedDensity load(const std::string& path);
    static TrainedDensity load(const std::string& path, const Domain& domain);

    // The notes of a file alone.
    static std::map<std::string, std::string> notes_of(const std::string& path);

    // The same as bytes in memory.
    std::vector<std::uint64_t> words() const;
    static TrainedDensity from_words(std::vector<std::uint64_t> words, const Domain* domain = nullptr);

  private:
    std::shared_ptr<const UnitDensity> unit_;
    Domain domain_;
    std::map<std::string, std::string> notes_;
};

} // namespace montelux
