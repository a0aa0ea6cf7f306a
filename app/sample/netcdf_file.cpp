#include "app/sample/netcdf_file.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <optional>
#include <span>

#include "montelux/mc/io/file.h"
#include "montelux/mc/io/shared_library.h"
#include "montelux/mc/math/error.h"

namespace montelux::app {
namespace {

// Of netcdf.h and netcdf_mem.h, which have not changed since netCDF 4.6.2.
constexpr int netcdf4_format = 0x1000, type_double = 6, type_int64 = 10, whole_group = -1;
struct MemoryImage {
    std::size_t size;
    void* memory;
    int flags;
};

// The functions of libnetcdf that are used.
class NetcdfApi {
  public:
    NetcdfApi();

    // Throws Error for a code that is not 0.
    void expect(int code) const {
        if (code != 0) throw Error("netCDF", text_of(code));
    }

    int (*create_in_memory)(const char*, int, std::size_t, int*);
    int (*close_image)(int, MemoryImage*);
    int (*define_group)(int, const char*, int*);
    int (*define_dimension)(int, const char*, std::size_t, int*);
    int (*define_variable)(int, const char*, int, int, const int*, int*);
    int (*put_text)(int, int, const char*, std::size_t, const char*);
    int (*put_doubles)(int, int, const double*);
    int (*put_integers)(int, int, const long long*);
    const char* (*text_of)(int);

  private:
    template <typename Function>
    void find(Function& function, const char* name) {
        function = library_->find<Function>(name);
        if (!function)
            throw Error(file_, std::string("this is not netCDF 4.6.2 or newer: it has no function ") + name);
    }

    std::string file_;
    std::optional<SharedLibrary> library_;
};

NetcdfApi::NetcdfApi() {
    std::string reason;
    const char* named = std::getenv(netcdf_library_variable);
    if (named && *named) {
        file_ = named;
        library_ = SharedLibrary::open(file_, reason);
        if (!library_)
            throw Error(netcdf_library_variable,
                        "netCDF cannot be loaded from '" + file_ + "', which this variable names: " + reason);
    } else {
        for (const char* name : {"libnetcdf.so.19", "libnetcdf.so.22", "libnetcdf.so", "libnetcdf.dylib"}) {
            file_ = name;
            library_ = SharedLibrary::open(file_, reason);
            if (library_) break;
        }
    }
    if (!library_)
        throw Error("netCDF",
                    std::string("the library libnetcdf was not found (Debian: apt install libnetcdf19); "
                                "install it, set ") +
                        netcdf_library_variable + " to its file, or choose --format csv or npy");
    find(create_in_memory, "nc_create_mem");
    find(close_image, "nc_close_memio");
    find(define_group, "nc_def_grp");
    find(define_dimension, "nc_def_dim");
    find(define_variable, "nc_def_var");
    find(put_text, "nc_put_att_text");
    find(put_doubles, "nc_put_var_double");
    find(put_integers, "nc_put_var_longlong");
    find(text_of, "nc_strerror");
}

const NetcdfApi& netcdf() {
    static const NetcdfApi api;
    return api;
}

// A file in memory. It is closed once, by `image`.
class NetcdfImage {
  public:
    NetcdfImage() { nc_.expect(nc_.create_in_memory("draws", netcdf4_format, 1 << 16, &file_)); }
    ~NetcdfImage() {
        if (file_ >= 0) close();
    }
    NetcdfImage(const NetcdfImage&) = delete;
    NetcdfImage& operator=(const NetcdfImage&) = delete;

    int group(const char* name) const {
        int id = 0;
        nc_.expect(nc_.define_group(file_, name, &id));
        return id;
    }
    // Its bytes; the file is closed.
    std::span<const std::uint8_t> bytes() {
        nc_.expect(close());
        return {static_cast<const std::uint8_t*>(image_.get()), size_};
    }

  private:
    int close() {
        MemoryImage image{};
        const int code = nc_.close_image(file_, &image);
        file_ = -1;
        image_.reset(image.memory);
        size_ = image.size;
        return code;
    }
    struct Free {
        void operator()(void* memory) const { std::free(memory); }
    };

    const NetcdfApi& nc_ = netcdf();
    int file_ = -1;
    std::unique_ptr<void, Free> image_;
    std::size_t size_ = 0;
};

} // namespace

void check_netcdf() { netcdf(); }

void write_netcdf(const std::string& path, const std::vector<std::string>& names, const ChainDraws& draws) {
    const NetcdfApi& nc = netcdf();
    NetcdfImage image;
    const int posterior = image.group("posterior");
    int dimensions[2] = {};
    nc.expect(nc.define_dimension(posterior, "chain", draws.chains, &dimensions[0]));
    nc.expect(nc.define_dimension(posterior, "draw", draws.draws, &dimensions[1]));
    const std::string library = "montelux", version = MONTELUX_VERSION;
    nc.expect(nc.put_text(posterior, whole_group, "inference_library", library.size(), library.c_str()));
    nc.expect(
        nc.put_text(posterior, whole_group, "inference_library_version", version.size(), version.c_str()));
    int variable = 0;
    for (int k : {0, 1}) {
        std::vector<long long> numbers(k == 0 ? draws.chains : draws.draws);
        std::iota(numbers.begin(), numbers.end(), 0);
        nc.expect(nc.define_variable(posterior, k == 0 ? "chain" : "draw", type_int64, 1, &dimensions[k],
                                     &variable));
        nc.expect(nc.put_integers(posterior, variable, numbers.data()));
    }
    std::vector<double> values(draws.chains * draws.draws);
    for (std::size_t d = 0; d < names.size(); ++d) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = draws.states[i * names.size() + d];
        nc.expect(nc.define_variable(posterior, names[d].c_str(), type_double, 2, dimensions, &variable));
        nc.expect(nc.put_doubles(posterior, variable, values.data()));
    }
    const std::span<const std::uint8_t> bytes = image.bytes();
    if (!path.empty()) {
        AtomicFile file(path);
        file.write(bytes);
        file.commit();
    } else if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size()) {
        throw Error("standard output", "cannot be written");
    }
}

} // namespace montelux::app
