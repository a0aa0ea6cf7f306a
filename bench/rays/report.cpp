#include "bench/rays/report.h"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "montelux/mc/math/error.h"

namespace montelux::bench {

void print_table(std::span<const RayRun> runs) {
    const std::vector<Tracing> columns = all_tracings();
    std::printf("Mrays/s, one thread; `differ`: rays per million in packets of 16 that answer otherwise than "
                "alone in any bit, and of these with another primitive\n\n");
    std::string_view scene;
    for (std::size_t first = 0; first < runs.size(); first += columns.size()) {
        const std::span row = runs.subspan(first, columns.size());
        if (row[0].scene != scene) {
            scene = row[0].scene;
            std::printf("%s| %s | order | rays |", first == 0 ? "" : "\n", row[0].scene.c_str());
            for (const Tracing& column : columns) std::printf(" %s |", column.name().c_str());
            std::printf(" differ |\n|---|---|---|");
            for (std::size_t i = 0; i < columns.size(); ++i) std::printf("---|");
            std::printf("---|\n");
        }
        std::printf("| %s%s | %s | %zu |", std::string(name_of(row[0].kind)).c_str(),
                    row[0].robust ? "" : ", not robust", std::string(name_of(row[0].order)).c_str(),
                    row[0].rays);
        double differing = 0, other = 0;
        for (const RayRun& run : row) {
            std::printf(" %.2f |", run.rate());
            if (run.tracing.packet == 16 && !run.tracing.coherent) {
                differing = 1e6 * static_cast<double>(run.result.differing) / static_cast<double>(run.rays);
                other = 1e6 * static_cast<double>(run.result.other_primitive) / static_cast<double>(run.rays);
            }
        }
        std::printf(" %.0f, %.0f |\n", differing, other);
    }
}

void write_json(const std::string& path, std::span<const RayRun> runs) {
    nlohmann::json rows = nlohmann::json::array();
    for (const RayRun& run : runs)
        rows.push_back({{"scene", run.scene},
                        {"kind", name_of(run.kind)},
                        {"order", name_of(run.order)},
                        {"robust", run.robust},
                        {"packet", run.tracing.packet},
                        {"coherent", run.tracing.coherent},
                        {"rays", run.rays},
                        {"mrays_per_second", run.rate()},
                        {"differing", run.result.differing},
                        {"other_primitive", run.result.other_primitive}});
    std::ofstream out(path);
    out << nlohmann::json{{"runs", rows}}.dump(1) << "\n";
    if (!out.flush()) throw Error(path, "could not be written");
}

} // namespace montelux::bench
