// DeviceJob: the one argument of the kernels, read by C++ and by the device's compiler alike.
// Standard headers do not exist there.
#pragma once

namespace montelux {

enum DevicePointKind {
    device_random_points,
    device_sobol_points,
    device_given_points,
    device_mixture_points
};

// A mixture of densities on the unit cube, as MixtureDensity has it. Channel 0 is uniform; the boundary's is before
// map_channel, the product of maps before first_gaussian, and the others are Gaussians.
struct DeviceMixture {
    int channels, map_channel, first_gaussian;
    const double* shares; // of each channel; they sum to 1

    // Maps: bins bin_begin[d] ... bin_begin[d + 1] - 1 of dimension d, each with six numbers (u0, du, x0, dx, and the
    // slopes at its ends). The density of the first is x^(powers[d] - 1), if that power is below 1.
    const int* bin_begin;
    const double *bins, *powers;
    const double* gaussians;

    // Points of a replicate: those numbered channel_begin[k] ... channel_begin[k + 1] - 1 are points channel_first[k]
    // and on of channel k's own sequence.
    const unsigned long long *channel_begin, *channel_first;
};

// Points of a batch.
enum DeviceBatch { device_batch = 1024 };

// Of the values f(x) of a batch, and of these times the change of volume: g.
struct DeviceSummary {
    double sum, squares;             // of g and of g^2, in the order of lane_sum
    double mean, squared_deviations; // of g, in the order of SampleMoments
    double least, greatest;          // of g
    double raw_least, raw_greatest;  // of f
    unsigned long long finite;       // are all f and g? Otherwise the other numbers say nothing
};

// Which points of the unit cube to take, and where to write. Pointers are to the device's memory. Arrays of n points
// are structures of arrays: number c of point i is at [c * n + i].
struct DeviceJob {
    unsigned long long count; // n
    int kind;                 // a DevicePointKind

    // Random points first, first + 1, ...: those of fill_random with this key (of seed and stream).
    unsigned long long first, key;
    unsigned int stream;

    // Sobol' points first ... first + points_each - 1 of each replicate in turn, as those of ScrambledSobol. A replicate
    // has a key for each dimension, and of each channel of a mixture; a dimension has 32 bit-reversed columns.
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

    // Mixture points first, first + 1, ... of all replicates in turn.
    DeviceMixture mixture;

    // Lower and upper end of each dimension; null: the unit cube.
    const double* ranges;
    const double* parameters; // of the integrand

    // Of an integrand of one component: each batch is summarised, of points_each points in turn, where summaries is not
    // null. The change of volume is `factor` where `volume` is null.
    DeviceSummary* summaries;
    unsigned long long batches;
    double factor;

    // Of mixture points outside the cube only the density is written.
    double* values;   // f(x), each component
    double* volume;   // |dx/du| of the ranges; may be null
    double* jacobian; // of the adaptive map; may be null
    double* density;  // of the mixture, 0 outside the cube; may be null
};

} // namespace montelux
