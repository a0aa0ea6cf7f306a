// Writes the tables of montelux/spectrum/rgb_uplift.h for every named colour space into one binary file,
// while Montelux is built: rgb_uplift_generator OUTPUT
#include <cstdio>
#include <fstream>
#include <future>
#include <iterator>
#include <vector>

#include "montelux/spectrum/rgb_uplift.h"
#include "montelux/spectrum/rgb_uplift_layout.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: rgb_uplift_generator OUTPUT\n", stderr);
        return 2;
    }
    std::vector<std::future<std::vector<montelux::Float4>>> tables;
    tables.reserve(std::size(montelux::rgb_uplift_layouts));
    for (const montelux::RgbUpliftLayout& layout : montelux::rgb_uplift_layouts)
        tables.push_back(std::async(std::launch::async, [&layout] {
            const montelux::RgbColorSpace& space = *montelux::find_rgb_color_space(layout.space);
            return montelux::RgbUpliftTable::compute(space, layout.resolution);
        }));
    std::ofstream out(argv[1], std::ios::binary);
    for (auto& table : tables) {
        const std::vector<montelux::Float4> nodes = table.get();
        out.write(reinterpret_cast<const char*>(nodes.data()),
                  static_cast<std::streamsize>(nodes.size() * sizeof(nodes[0])));
    }
    out.close();
    if (!out) {
        std::fprintf(stderr, "%s: cannot write the tables\n", argv[1]);
        return 1;
    }
    return 0;
}
