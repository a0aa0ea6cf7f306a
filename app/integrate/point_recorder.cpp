#include "app/integrate/point_recorder.h"

#include "app/table_file.h"

namespace montelux::app {

void PointRecorder::add(const PointBatch& x, ValueBatch y) {
    for (std::size_t i = 0; i < x.count() && count_ < limit_; ++i, ++count_) {
        for (int d = 0; d < x.dimensions(); ++d) rows_.push_back(x(i, d));
        for (int c = 0; c < y.components(); ++c) rows_.push_back(y(i, c));
    }
}

void PointRecorder::write(const std::string& path, const std::vector<std::string>& variables,
                          const std::vector<std::string>& formulas) const {
    std::vector<std::string> names = variables;
    names.insert(names.end(), formulas.begin(), formulas.end());
    TableWriter table(path, TableFormat::csv, names, count_);
    for (std::size_t i = 0; i < count_; ++i)
        table.add(std::span(rows_).subspan(i * names.size(), names.size()));
    table.finish();
}

} // namespace montelux::app
