// IterationHistory: the estimates after each step of a run, in bounded memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/result.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

class IterationHistory {
  public:
    // After 4096 records every second of the older ones is dropped.
    void add(const IterationRecord& record) {
        records_.push_back(record);
        if (records_.size() < 4096) return;
        std::size_t kept = 0;
        for (std::size_t i = 1; i < records_.size(); i += 2) records_[kept++] = records_[i];
        records_.resize(kept);
    }
    const std::vector<IterationRecord>& records() const { return records_; }

    void save(StateWriter& state) const {
        state.put(static_cast<std::uint64_t>(records_.size()));
        for (const IterationRecord& r : records_) {
            state.put(r.evaluations);
            state.put(r.value);
            state.put(r.standard_error);
            state.put(r.seconds);
        }
    }
    void load(StateReader& state) {
        records_.resize(std::min<std::uint64_t>(state.get_word(), 1 << 16));
        for (IterationRecord& r : records_) {
            r.evaluations = state.get_word();
            r.value = state.get_double();
            r.standard_error = state.get_double();
            r.seconds = state.get_double();
        }
    }

  private:
    std::vector<IterationRecord> records_;
};

} // namespace montelux
