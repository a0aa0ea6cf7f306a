// How fast scenes are read: text geometry, binary meshes, subdivision.
#include <benchmark/benchmark.h>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "montelux/formats/loop_subdivision.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/formats/ply.h"

namespace montelux {
namespace {

// About 100 MB of one triangle mesh with positions, normals and indices, as exporters write them.
const std::string& large_text() {
    static const std::string text = [] {
        std::mt19937 random(1);
        auto coordinate = [&] { return (static_cast<double>(random()) / 2147483648.0 - 1) * 100; };
        std::string s = "WorldBegin\nLightSource \"point\"\nShape \"trianglemesh\"\n";
        constexpr int vertices = 1100000;
        char line[128];
        auto triples = [&](const char* name, double scale) {
            s += std::string("\"") + name + "\" [\n";
            for (int i = 0; i < vertices; ++i) {
                double x = coordinate() * scale, y = coordinate() * scale, z = coordinate() * scale;
                s.append(line, static_cast<std::size_t>(
                                   std::snprintf(line, sizeof line, "%.6g %.6g %.6g\n", x, y, z)));
            }
            s += "]\n";
        };
        triples("point3 P", 1);
        triples("normal N", 0.01);
        s += "\"integer indices\" [\n";
        for (int i = 0; i < 2 * vertices; ++i) {
            unsigned long a = random() % vertices, b = random() % vertices, c = random() % vertices;
            s.append(line,
                     static_cast<std::size_t>(std::snprintf(line, sizeof line, "%lu %lu %lu\n", a, b, c)));
        }
        return s + "]\n";
    }();
    return text;
}

void text_geometry(benchmark::State& state) {
    const std::string& text = large_text();
    for (auto _ : state) {
        Warnings warnings;
        benchmark::DoNotOptimize(parse_pbrt(text, "bench", ".", warnings));
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
    state.counters["MB"] = static_cast<double>(text.size()) * 1e-6;
}
BENCHMARK(text_geometry)->Unit(benchmark::kMillisecond);

// Vertices with normals and texture coordinates, faces as lists.
void binary_ply(benchmark::State& state) {
    constexpr std::uint32_t vertices = 1000000, faces = 2000000;
    std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex 1000000\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
        file += std::string("property float ") + name + "\n";
    file += "element face 2000000\nproperty list uchar int vertex_indices\nend_header\n";
    file.resize(file.size() + vertices * 32);
    for (std::uint32_t i = 0; i < faces; ++i) {
        std::uint32_t face[3] = {i % vertices, (i + 1) % vertices, (i + 2) % vertices};
        file += '\3';
        file.append(reinterpret_cast<const char*>(face), sizeof face);
    }
    std::vector<std::uint8_t> bytes(file.begin(), file.end());
    for (auto _ : state) benchmark::DoNotOptimize(parse_ply(bytes, "bench"));
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes.size()));
}
BENCHMARK(binary_ply)->Unit(benchmark::kMillisecond);

void loop_subdivision(benchmark::State& state) {
    std::vector<Vec3f> p = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Index> i = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    for (auto _ : state) benchmark::DoNotOptimize(subdivide_loop(p, i, 8));
}
BENCHMARK(loop_subdivision)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace montelux
