#include "montelux/formats/gunzip.h"

#include <algorithm>
#include <limits>
#include <zlib.h>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class Inflater {
  public:
    explicit Inflater(std::string_view name) {
        constexpr int gzip_only = 15 + 16; // window bits, and a gzip header is expected
        if (inflateInit2(&stream_, gzip_only) != Z_OK) throw Error(name, "zlib cannot be started");
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    z_stream& stream() { return stream_; }

  private:
    z_stream stream_{};
};

} // namespace

std::vector<std::uint8_t> gunzip(std::span<const std::uint8_t> bytes, std::string_view name,
                                 std::size_t max_bytes) {
    constexpr std::size_t unsuspicious_bytes = std::size_t{16} << 20, largest_ratio = 128;
    const std::size_t in_proportion = std::max(unsuspicious_bytes, largest_ratio * bytes.size());
    const std::size_t limit = std::min(max_bytes, in_proportion);
    Inflater inflater(name);
    z_stream& z = inflater.stream();
    std::vector<std::uint8_t> result(
        std::min(limit, std::max<std::size_t>(4 * bytes.size(), std::size_t{1} << 12)));
    std::size_t read = 0, written = 0;
    constexpr std::size_t piece = std::numeric_limits<uInt>::max();
    for (;;) {
        if (written == result.size()) {
            if (written == max_bytes)
                throw Error(name, "unpacks to more than " + std::to_string(max_bytes) + " bytes");
            if (written == limit)
                throw Error(name, "unpacks to more than " + std::to_string(limit >> 20) +
                                      " MiB, which is out of proportion to its " +
                                      std::to_string(bytes.size()) + " bytes");
            result.resize(std::min(limit, 2 * written));
        }
        std::size_t room = std::min(piece, result.size() - written);
        std::size_t available = std::min(piece, bytes.size() - read);
        z.next_in = const_cast<Bytef*>(bytes.data() + read); // zlib does not write through it
        z.avail_in = static_cast<uInt>(available);
        z.next_out = result.data() + written;
        z.avail_out = static_cast<uInt>(room);
        int status = inflate(&z, Z_NO_FLUSH);
        read += available - z.avail_in;
        written += room - z.avail_out;
        if (status == Z_STREAM_END) {
            if (read == bytes.size()) break;
            if (inflateReset(&z) != Z_OK) throw Error(name, "zlib cannot be started again");
        } else if (status == Z_BUF_ERROR || (status == Z_OK && read == bytes.size() && z.avail_out > 0)) {
            if (z.avail_out > 0) throw Error(name, "the gzip data ends early");
        } else if (status != Z_OK) {
            throw Error(name,
                        std::string("the gzip data is damaged (") + (z.msg ? z.msg : "zlib error") + ")");
        }
    }
    result.resize(written);
    return result;
}

} // namespace montelux
