// The regions of an adaptive integration: boxes that fill the unit cube, each with its values and errors.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// Regions in structure of arrays, each with a box, and a value and an error per component.
class CubatureRegions {
  public:
    // Marks of an evaluated region.
    struct Marks {
        std::uint8_t axis = 0;      // to halve it along
        bool rough = false;         // the integrand is not smooth at its scale
        bool exhausted = false;     // its errors are only rounding
        bool indivisible = false;   // its halves are equal in floating point
        std::uint8_t face_axis = 0; // the face that face_error() is about
        bool face_upper = false;
    };

    CubatureRegions(int dimensions, int components) : n_(size(dimensions)), m_(size(components)) {}

    std::size_t count() const { return marks_.size(); }
    bool empty() const { return marks_.empty(); }
    // Bytes that one region takes.
    std::size_t bytes_each() const { return 8 * (2 * n_ + 8 * m_) + sizeof(Marks); }

    std::span<double> centre(std::size_t r) { return {&centre_[r * n_], n_}; }
    std::span<const double> centre(std::size_t r) const { return {&centre_[r * n_], n_}; }
    std::span<double> half_width(std::size_t r) { return {&half_width_[r * n_], n_}; }
    std::span<const double> half_width(std::size_t r) const { return {&half_width_[r * n_], n_}; }
    std::span<double> value(std::size_t r) { return {&value_[r * m_], m_}; }
    std::span<const double> value(std::size_t r) const { return {&value_[r * m_], m_}; }
    std::span<double> error(std::size_t r) { return {&error_[r * m_], m_}; }
    std::span<const double> error(std::size_t r) const { return {&error_[r * m_], m_}; }
    // The part of the error that is due to a suspected jump at a face.
    std::span<double> face_error(std::size_t r) { return {&face_error_[r * m_], m_}; }
    std::span<const double> face_error(std::size_t r) const { return {&face_error_[r * m_], m_}; }
    // The least and the greatest value that the rule saw.
    std::span<double> lowest(std::size_t r) { return {&lowest_[r * m_], m_}; }
    std::span<const double> lowest(std::size_t r) const { return {&lowest_[r * m_], m_}; }
    std::span<double> highest(std::size_t r) { return {&highest_[r * m_], m_}; }
    std::span<const double> highest(std::size_t r) const { return {&highest_[r * m_], m_}; }
    // Prediction of a component at an end of a region of one variable (SymmetricRule::FaceValue).
    struct Face {
        double value, slack, unseen;
    };
    // Differences between the values of halved regions and those of their halves, kept by the half of the larger error:
    // the last one, and the mean logarithm of the ratios of one to that before.
    struct Series {
        double difference = 0, log_ratio = 0, ratios = 0; // ratios: their number
    };
    Series& series(std::size_t r, std::size_t c) { return series_[r * m_ + c]; }
    Face& face(std::size_t r, std::size_t c, bool upper) { return faces_[2 * (r * m_ + c) + upper]; }
    const Face& face(std::size_t r, std::size_t c, bool upper) const {
        return faces_[2 * (r * m_ + c) + upper];
    }
    Marks& marks(std::size_t r) { return marks_[r]; }
    const Marks& marks(std::size_t r) const { return marks_[r]; }
    double volume(std::size_t r) const;
    // Of a point from the centre, in half widths: at most 1 inside, but for rounding.
    double distance(std::size_t r, std::span<const double> x) const;
    // Is the point inside, or on a face?
    bool touches(std::size_t r, std::span<const double> x) const;
    // The region that holds the point of the unit cube.
    std::size_t containing(std::span<const double> x) const;

    void resize(std::size_t count);
    // Adds the unit cube, not yet evaluated.
    void add_cube();
    // Adds both halves of a region of `from`, not yet evaluated.
    void add_halves(const CubatureRegions& from, std::size_t region);
    // Region `to` becomes a copy of region `r` of `from`.
    void copy(std::size_t to, const CubatureRegions& from, std::size_t r);

    void save(StateWriter& state) const;
    // Throws Error where the state does not fit.
    void load(StateReader& state);

  private:
    static std::size_t size(int n) { return static_cast<std::size_t>(n); }

    std::size_t n_, m_;
    std::vector<double> centre_, half_width_, value_, error_, face_error_, lowest_, highest_;
    std::vector<Series> series_;
    std::vector<Face> faces_; // empty in several variables
    std::vector<Marks> marks_;
};

} // namespace montelux
