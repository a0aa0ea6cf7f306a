#include "montelux/mc/io/generation_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>

#include "montelux/mc/io/file.h"
#include "montelux/mc/io/siphash.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Precedes the payload, little-endian as in memory. The checksum covers everything before it and the payload.
struct Header {
    std::array<char, 8> magic;
    std::uint64_t version;
    std::array<char, 32> kind; // padded with zeros, one at least
    std::uint64_t payload_size;
    std::array<std::uint64_t, 2> checksum;
};
static_assert(sizeof(Header) == 72 && std::endian::native == std::endian::little);

constexpr std::array<char, 8> magic{'m', 't', 'l', 'x', 'g', 'e', 'n', '\n'};
constexpr std::uint64_t version = 1;

SipHash128 begin_checksum(const Header& header) {
    SipHash128 hash(0x6d6f6e74656c7578, 0x67656e65726174ff); // any key
    hash.add({reinterpret_cast<const std::uint8_t*>(&header), offsetof(Header, checksum)});
    return hash;
}

std::string bytes_text(std::uint64_t n) { return std::to_string(n) + (n == 1 ? " byte" : " bytes"); }

std::array<char, 32> kind_field(std::string_view kind) {
    std::array<char, 32> field{};
    if (kind.empty() || kind.size() >= field.size() || kind.find('\0') != kind.npos)
        throw Error("generation file",
                    "the kind '" + std::string(kind) + "' was given; expected 1 to 31 bytes");
    std::copy(kind.begin(), kind.end(), field.begin());
    return field;
}

// From here on the file's size agrees with its header.
Header read_header(InputFile& file, const std::string& path, std::uint64_t max_bytes) {
    Header header{};
    const std::uint64_t size = file.size();
    file.read({reinterpret_cast<std::uint8_t*>(&header), std::min<std::uint64_t>(size, sizeof header)});
    // A part of the magic word: the file was cut short early.
    if (!std::equal(magic.begin(), magic.begin() + std::min<std::uint64_t>(size, magic.size()),
                    header.magic.begin()))
        throw Error(path, "is not a saved state of Montelux");
    if (size < sizeof header)
        throw Error(path, "is cut short: it has " + bytes_text(size) + "; its header alone takes " +
                              bytes_text(sizeof header));
    if (header.version != version)
        throw Error(path, "was saved in version " + std::to_string(header.version) +
                              " of the format; expected " + std::to_string(version));
    const std::uint64_t payload = size - sizeof header;
    if (header.payload_size > max_bytes)
        throw Error(path, "says that it holds " + bytes_text(header.payload_size) + "; expected at most " +
                              bytes_text(max_bytes));
    if (header.payload_size > payload)
        throw Error(path, "is cut short: it holds " + bytes_text(payload) + " of " +
                              bytes_text(header.payload_size));
    if (header.payload_size < payload)
        throw Error(path, "is damaged: " + bytes_text(payload - header.payload_size) + " follow its end");
    return header;
}

void check_end(const Header& header, const SipHash128& hash, const std::string& path, std::string_view kind) {
    if (hash.digest() != header.checksum) throw Error(path, "is damaged: its checksum does not fit");
    // After the checksum, so that a damaged name is not taken for another kind.
    if (header.kind != kind_field(kind))
        throw Error(path, "holds the state of '" + std::string(header.kind.data()) + "'; expected '" +
                              std::string(kind) + "'");
}

std::vector<std::uint8_t> read_whole(const std::filesystem::path& path, std::string_view kind,
                                     std::uint64_t max_bytes) {
    InputFile file(path);
    const Header header = read_header(file, path.string(), max_bytes);
    SipHash128 hash = begin_checksum(header);
    std::vector<std::uint8_t> payload(header.payload_size);
    file.read(payload);
    hash.add(payload);
    check_end(header, hash, path.string(), kind);
    return payload;
}

// Like read_whole, without the memory.
bool is_whole(const std::filesystem::path& path, std::string_view kind) {
    try {
        InputFile file(path);
        const Header header = read_header(file, path.string(), UINT64_MAX);
        SipHash128 hash = begin_checksum(header);
        std::vector<std::uint8_t> buffer(std::size_t{1} << 20);
        for (std::uint64_t left = header.payload_size; left > 0;) {
            const std::span<std::uint8_t> piece(buffer.data(), std::min<std::uint64_t>(left, buffer.size()));
            file.read(piece);
            hash.add(piece);
            left -= piece.size();
        }
        check_end(header, hash, path.string(), kind);
        return true;
    } catch (const Error&) {
        return false;
    }
}

bool are_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    struct stat x {
    }, y{};
    return ::stat(a.c_str(), &x) == 0 && ::stat(b.c_str(), &y) == 0 && x.st_dev == y.st_dev &&
           x.st_ino == y.st_ino;
}

std::filesystem::path before_its_renaming(const std::filesystem::path& previous) {
    return previous.string() + ".tmp";
}

// Gives the present file the name of the previous generation as well as its own.
void keep_as_previous(const std::filesystem::path& present, const std::filesystem::path& previous,
                      const std::filesystem::path& path) {
    // They are the same file if a process ended between the two renamings; rename() would then do nothing.
    if (are_one_file(present, previous)) return;
    auto fail = [&](int error_number) {
        throw Error(path.string(), "cannot be written: the previous generation could not be kept as '" +
                                       previous.string() + "': " + std::strerror(error_number));
    };
    // Linking cannot replace a name that is taken, renaming can.
    const std::filesystem::path second = before_its_renaming(previous);
    ::unlink(second.c_str()); // of a process that was killed
    if (::link(present.c_str(), second.c_str()) == 0) {
        if (::rename(second.c_str(), previous.c_str()) == 0) return;
        const int error_number = errno;
        ::unlink(second.c_str());
        fail(error_number);
    }
    // File systems without hard links: for a moment the previous generation is the only one.
    if (errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS && errno != EMLINK) fail(errno);
    if (::rename(present.c_str(), previous.c_str()) != 0) fail(errno);
}

} // namespace

std::filesystem::path previous_generation(const std::filesystem::path& path) {
    return output_target(path).string() + ".previous";
}

void check_generation_writable(const std::filesystem::path& path) {
    const AtomicFile never_committed(path), second(before_its_renaming(previous_generation(path)));
}

bool generation_exists(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) ||
           std::filesystem::exists(previous_generation(path), ignored);
}

void write_generation(const std::filesystem::path& path, std::string_view kind,
                      std::span<const std::uint8_t> payload) {
    Header header{magic, version, kind_field(kind), payload.size(), {}};
    SipHash128 hash = begin_checksum(header);
    hash.add(payload);
    header.checksum = hash.digest();

    const std::filesystem::path target = output_target(path);
    AtomicFile file(path);
    file.write(&header, sizeof header);
    file.write(payload);
    file.finish();
    // A damaged file must not take the place of a whole one.
    if (is_whole(target, kind)) keep_as_previous(target, previous_generation(path), path);
    file.commit();
    sync_folder_of(target);
}

Generation read_generation(const std::filesystem::path& path, std::string_view kind, std::size_t max_bytes) {
    Generation generation;
    try {
        generation.payload = read_whole(path, kind, max_bytes);
        return generation;
    } catch (const Error& error) {
        generation.newest_refused_because = error.what();
    }
    try {
        generation.previous = true;
        generation.payload = read_whole(previous_generation(path), kind, max_bytes);
        return generation;
    } catch (const Error& error) {
        throw Error(generation.newest_refused_because + "; " + error.what());
    }
}

} // namespace montelux
