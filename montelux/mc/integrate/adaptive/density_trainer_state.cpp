// DensityTrainer::save and load.
#include <algorithm>
#include <utility>

#include "montelux/mc/integrate/adaptive/density_trainer.h"
#include "montelux/mc/math/error.h"

namespace montelux {

void DensityTrainer::save(StateWriter& state) const {
    density_.save(state);
    state.put(scale_);
    state.put(static_cast<std::uint64_t>(recent_.size()));
    for (const Round& r : recent_) {
        r.density.save(state);
        state.put(static_cast<std::uint64_t>(r.h.size()));
        for (int d = 0; d < density_.dimensions(); ++d)
            for (double v : r.x.view().coordinate(d)) state.put(v);
        for (double v : r.h) state.put(v);
        for (double v : r.p) state.put(v);
    }
    state.put(remembered_h_);
    for (int d = 0; d < remembered_.dimensions(); ++d)
        for (double v : remembered_.view().coordinate(d)) state.put(v);
    for (const WalkedPoints* walked : {&walked_, &scouts_}) {
        state.put(walked->h);
        state.put(walked->exponent);
        for (int d = 0; d < walked->x.dimensions(); ++d)
            for (double v : walked->x.view().coordinate(d)) state.put(v);
    }
    state.put(static_cast<std::uint64_t>(checks_.size()));
    for (const Check& c : checks_) {
        state.put(c.value);
        state.put(c.variance);
    }
    state.put(rounds_);
    state.put(walks_);
    state.put(enriched_);
    state.put(flat_size_);
    state.put(share_step_);
    state.put(relative_variance_);
    state.put(effective_share_);
    state.put(uncovered_share_);
    state.put(nonzero_);
    state.put(evaluations_);
    state.put(peaks_);
    state.put(searched_points_);
    state.put(search_evaluations_);
    montelux::save(state, non_finite_);
}

void DensityTrainer::load(StateReader& state) {
    const int dimensions = density_.dimensions();
    density_ = MixtureDensity::load(state, dimensions);
    scale_ = state.get_doubles();
    recent_.clear();
    for (std::uint64_t rounds = state.get_word(); rounds > 0; --rounds) {
        Round r{MixtureDensity::load(state, dimensions), {}, {}, {}};
        const std::uint64_t count = state.get_word();
        if (count > (std::uint64_t{1} << 32)) throw Error("the saved state is damaged");
        r.x.resize(count, dimensions);
        for (int d = 0; d < dimensions; ++d)
            for (double& v : r.x.coordinate(d)) v = state.get_double();
        r.h.resize(count);
        for (double& v : r.h) v = state.get_double();
        r.p.resize(count);
        for (double& v : r.p) v = state.get_double();
        recent_.push_back(std::move(r));
    }
    remembered_h_ = state.get_doubles();
    remembered_.resize(remembered_h_.size(), dimensions);
    for (int d = 0; d < dimensions; ++d)
        for (double& v : remembered_.coordinate(d)) v = state.get_double();
    for (WalkedPoints* walked : {&walked_, &scouts_}) {
        walked->h = state.get_doubles();
        walked->exponent = state.get_double();
        walked->x.resize(walked->h.size(), dimensions);
        for (int d = 0; d < dimensions && !walked->h.empty(); ++d)
            for (double& v : walked->x.coordinate(d)) v = state.get_double();
    }
    checks_.clear();
    for (std::uint64_t n = state.get_word(); n > 0; --n) {
        const double value = state.get_double();
        checks_.push_back({value, state.get_double()});
    }
    rounds_ = state.get<int>();
    walks_ = state.get<int>();
    enriched_ = state.get<int>() != 0;
    flat_size_ = state.get_double();
    share_step_ = std::clamp(state.get<int>(), 1, MixtureDensity::units);
    relative_variance_ = state.get_double();
    effective_share_ = state.get_double();
    uncovered_share_ = state.get_double();
    nonzero_ = state.get_word();
    evaluations_ = state.get_word();
    peaks_ = state.get_word();
    searched_points_ = state.get_word();
    search_evaluations_ = state.get_word();
    montelux::load(state, non_finite_);
}

} // namespace montelux
