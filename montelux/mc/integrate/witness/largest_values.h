// The largest values that a run has seen, which whatever it claims must explain.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// A point of the unit cube and the values g there, one per component.
struct Witness {
    std::vector<double> u, value;
    double volume = 1; // of the part of the cube that it may speak for
    // Half widths of a peak with this top, along each variable, where |g| stays above a half; empty for other points.
    std::vector<double> extent = {};
    bool is_part = false; // of a ridge, beside other parts: their masses add up
};

void save(StateWriter& state, const Witness& w);
void load(StateReader& state, Witness& w);

// For each component the point with the largest |g| of all evaluations. Safe to use from several threads; the same
// points give the same witnesses in any order, as the first in lexicographic order counts among equal values.
class LargestValues {
  public:
    explicit LargestValues(int components);

    // Values are finite.
    void add(const PointBatch& u, const ValueBatch& g);
    // Would `add` learn from values of a component between these two?
    bool learns(std::size_t component, double least, double greatest) const;
    bool learns(const ValueBatch& g) const;
    // One per component that was ever other than zero.
    std::vector<Witness> witnesses() const;
    // Do values of a component cancel? True where both signs were seen, and where nothing was.
    bool cancels(std::size_t component) const;
    void clear();

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    struct Largest {
        std::atomic<double> size = 0;             // |g| of the witness, read without the lock
        std::atomic<bool> negative{}, positive{}; // were such values seen?
        Witness witness;
    };
    std::vector<Largest> largest_;
    mutable std::mutex mutex_;
};

} // namespace montelux
