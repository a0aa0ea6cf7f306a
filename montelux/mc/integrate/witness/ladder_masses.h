// Masses of shells along ladders: whether the integral diverges there, and what of it doubles do not resolve.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "montelux/mc/integrate/witness/ladder_path.h"
#include "montelux/mc/integrate/witness/largest_values.h"
#include "montelux/mc/integrate/witness/raw_values.h"
#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {

class LadderMasses {
  public:
    // Components of the integrand at the points of a ladder, in its order.
    using Rows = std::span<const std::vector<double>>;

    // Evaluates further shells by `raw`, in other directions by `paths`; both outlive it.
    LadderMasses(RawValues& raw, LadderPaths& paths);

    // Notes the masses of a value that was seen; false if it is not finite.
    bool see(const std::vector<double>& row, double volume);

    // Exponent from which on the values of a component along a path are noise whose masses grow; infinite if there is none.
    double noise(const LadderPath& path, Rows rows, std::size_t c);
    // Whether the masses do not fall. Shells of less than the rounding of the largest mass that was seen do not tell. If they
    // fall, adds what lies closer to an end or a pole, or farther out, than values are resolved.
    bool diverge(const LadderPath& path, Rows rows, std::size_t c, double noise);
    // Adds so many times the mass of a part of a ridge.
    void add_unresolved(const Witness& part, double times);
    // Part of the integral of each component; empty where all is resolved.
    const std::vector<double>& unresolved() const { return unresolved_; }

  private:
    // A ladder to the same place in another direction, and through another point in the variables that do not move.
    LadderPath another(LadderPath path);
    // The last shell of a ladder where a component is not zero; the second one if that is zero, too.
    static std::size_t last_shell(Rows rows, std::size_t c);
    static double mass(const LadderPath& path, Rows rows, std::size_t c, std::size_t before);
    static bool falls_less_than(double part, const LadderPath& path, Rows rows, std::size_t c);
    void add_unresolved(const LadderPath& path, std::size_t c, double mass);
    static bool is_suspicious(const LadderPath& path, Rows rows, std::size_t c);
    bool is_negligible(const LadderPath& path, Rows rows, std::size_t c) const;
    bool is_negligible(const LadderPath& path, Rows rows, std::size_t c, std::size_t shell) const;
    bool diverge_further(const LadderPath& path, std::size_t c);
    bool diverge_along(LadderPath path, std::size_t c);
    bool diverge_at_infinity(const LadderPath& path, std::size_t c);
    static bool is_largest_before_overflow(const ShellValues& values, double finest, int codimension);
    bool ridge_diverges_along(const LadderPath& path, std::size_t c);
    double mass_farther_out(const LadderPath& path, std::size_t c, double finest);
    // The last shell to which values rise and after which they drop by rounding, and the mass beyond; none where that is 0.
    struct Drop {
        std::size_t shell = 0;
        double mass = 0; // in units of the volume at exponent 0
    };
    Drop drop_by_rounding(const LadderPath& path, Rows rows, std::size_t c);
    double mass_of_rounding(const LadderPath& path, std::size_t c, std::size_t shell);
    bool faces_diverge(const LadderPath& path, std::size_t c, std::size_t shell);
    double mass_beyond_shells(const LadderPath& path, Rows rows, std::size_t c);
    ShellValues values_along(const LadderPath& path, std::size_t c);
    ShellValues values_far_out(const LadderPath& path, std::size_t c);

    RawValues& raw_;
    LadderPaths& paths_;
    std::vector<double> most_;        // of the masses that were seen
    std::size_t places_of_faces_ = 0; // that were examined
    std::vector<double> unresolved_;
    // Parts of it: the largest mass of all paths that lead to one side of a pole.
    struct Added {
        LadderPath path;
        std::size_t component;
        double mass;
    };
    std::vector<Added> added_;
};

} // namespace montelux
