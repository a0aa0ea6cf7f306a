// Messages between the leader of a render and its workers.
#pragma once

#include <cstdint>

namespace montelux::protocol {

// Tags of messages. A tile is named by its number in tiles_of() the film's crop.
enum Tag : int {
    // To a worker.
    assign = 1,  // Assignments, one after another
    release,     // a tile's number: send its pixels back and forget them
    gather,      // a number: send back all changed pixels, and all splats; forget open assignments
    take_groups, // Groups
    drop_groups, // forget groups of chains that were not sent yet
    guide,       // GuidePiece, and bytes of GuidingField::save: paths follow it from now on
    end,         // the render is over
    // In both directions.
    beat, // the sender is alive; a worker says so before its hello, too
    // To the leader.
    hello,          // a worker's number of threads: it is ready
    done,           // TaskReports, one after another
    tiles,          // TilePixels, one after another
    splats,         // for each tile that has any: its number, and its sums of the SplatFilm, row by row
    splat_counts,   // SplatCounts, after the splats
    bias,           // the sums of MergingBias::open(), and SplatCounts
    gathered,       // after the last of what `gather` asked for: its number
    paths,          // a number: how many paths of the groups in hand were taken
    replicate_part, // ReplicatePart, and as many ChainReplicate::PixelValues
    replicate,      // after its parts: its number, ChainGroup::Tally, ChainCosts
    guide_taken,    // the worker has the piece
    failed,         // why the worker cannot continue; its last message
    wish,           // this rank received a signal: cancel the render
};

// Renders at most `step` more samples per pixel of a tile. Data that the worker does not have yet follows.
struct Assignment {
    enum class TargetSamples : std::uint8_t {
        known,
        uniform,
        each
    }; // uniform: one number follows; each: one per pixel
    enum class Pixels : std::uint8_t { known, fresh, follow }; // fresh: without a sample
    std::uint32_t tile = 0, step = 0;
    TargetSamples target_samples = TargetSamples::known;
    Pixels pixels = Pixels::known;
};

// Result of an assignment.
struct TaskReport {
    std::uint32_t tile = 0;
    std::uint64_t samples = 0;   // that were taken
    std::uint64_t remaining = 0; // up to the target sample counts of the round
    double cpu_seconds = 0;
    // Sums over the tile's pixels: luminance, and its squared error; only for progress.
    double luminance = 0, squared_error = 0;
};

// Followed by as many pixels as the tile has, and for each FilmLayers::sums() numbers and Film::buckets_per_pixel()
// BucketMoments. So are the pixels that follow an assignment.
struct TilePixelsHeader {
    std::uint32_t tile = 0, pixels = 0;
    // The TileTally since the tile was last sent follows too, before the pixels.
};

// Of all splats since the last gathering: SplatFilm::bad() and overflows().
struct SplatCounts {
    std::uint64_t bad = 0, overflows = 0;
};

// Groups of chains, by their numbers among the film's replicates.
struct Groups {
    std::uint64_t first = 0, count = 0;
};

// Some pixels of a replicate.
struct ReplicatePart {
    std::uint64_t number = 0;
    std::uint64_t first = 0, count = 0; // of pixels
};

struct GuidePiece {
    std::uint64_t first = 0; // byte
    std::uint64_t size = 0;  // of the whole guide; 0: none
};

} // namespace montelux::protocol
