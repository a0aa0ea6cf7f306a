// DeviceJob: the one argument of the kernels, read by C++ and by the device's compiler alike.
// Standard headers do not exist there.
#pragma once

namespace montelux {

enum DevicePointKind { device_random_points, device_sobol_points, device_given_points };

// Which points of the unit cube to take, and where to write. Pointers are to the device's memory. Arrays of n points
// are structures of arrays: number c of point i is at [c * n + i].
struct DeviceJob {
    unsigned long long count; // n
    int kind;                 // a DevicePointKind

    // Random points first, first + 1, ...: those of fill_random with this key (of seed and stream).
    unsigned long long first, key;
    unsigned int stream;

    // Sobol' points first ... first + points_each - 1 of each replicate in turn, as those of ScrambledSobol. A replicate
    // has a key for each dimension; a dimension has 32 bit-reversed columns.
    unsigned long long points_each;
    const unsigned int *sobol_keys, *sobol_columns;

    // Points x that are given; they are neither moved nor mapped.
    const double* given;

    // Hypercubes: box h holds the points box_begin[h] ... box_begin[h + 1] - 1 of the sequence, strata[d] boxes in a
    // row. Without them box_begin is null.
    const unsigned long long* box_begin;
    unsigned long long boxes;
    const int* strata;

    // The edges of an adaptive map, increments + 1 for each dimension; null: the identity.
    const double* edges;
    int increments;

    // Lower and upper end of each dimension; null: the unit cube.
    const double* ranges;
    const double* parameters; // of the integrand

    double* values;   // f(x), each component
    double* volume;   // |dx/du| of the ranges; may be null
    double* jacobian; // of the adaptive map; may be null
};

} // namespace montelux
