// TexelFile: a temporary file of texels that are read through memory maps, with a limit of what is resident.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <sys/types.h>

#include "montelux/image/resident_limit.h"

namespace montelux {

class TexelBlock;

// The file has no name and disappears with its process. Pages that are not resident are read when a look-up needs
// them: from the kernel's page cache, or from the disk. A process that is forked off reads the blocks that there are, and
// writes none.
class TexelFile : public std::enable_shared_from_this<TexelFile> {
  public:
    static constexpr std::size_t least_limit = std::size_t{16} << 20;

    // At most about `limit` bytes of it are resident (ResidentLimit). Throws Error below least_limit, where no
    // file can be made in the folder, and where the folder itself is in memory.
    static std::shared_ptr<TexelFile> create(std::size_t limit,
                                             const std::filesystem::path& folder = default_folder());
    ~TexelFile();
    TexelFile(const TexelFile&) = delete;
    TexelFile& operator=(const TexelFile&) = delete;

    // TMPDIR, or /tmp; but /var/tmp where TMPDIR is not set and /tmp is in memory.
    static std::filesystem::path default_folder();

    // Zeros at first. Throws Error where the folder has no space; from any thread.
    std::shared_ptr<TexelBlock> allocate(std::size_t bytes);

    // Of all blocks there are.
    std::size_t bytes() const { return bytes_; }
    std::size_t limit() const { return limit_.bytes(); }
    std::size_t resident() const { return limit_.resident(); }

  private:
    friend class TexelBlock;
    TexelFile(std::size_t limit, std::filesystem::path folder);
    [[noreturn]] void fail(const char* what, std::size_t bytes, int error_number) const;
    void require_own_process() const;

    std::filesystem::path folder_;
    int descriptor_ = -1;
    pid_t process_;
    std::atomic<std::uint64_t> end_{0};
    std::atomic<std::size_t> bytes_{0};
    ResidentLimit limit_;
};

// A part of the file. Its space is given back when nothing refers to it any more.
class TexelBlock {
  public:
    ~TexelBlock();
    TexelBlock(const TexelBlock&) = delete;
    TexelBlock& operator=(const TexelBlock&) = delete;

    // Stays valid while the block lives.
    std::span<const std::byte> bytes() const { return mapping_; }
    // Threads may write different parts at the same time. Throws Error.
    void write(std::size_t offset, std::span<const std::byte> bytes);
    // Makes nothing of it resident until it is read again. For readers of whole blocks, which are faster than the
    // thread of ResidentLimit.
    void give_back() const;
    const std::shared_ptr<TexelFile>& file() const { return file_; }

  private:
    friend class TexelFile;
    TexelBlock(std::shared_ptr<TexelFile> file, std::uint64_t position, std::span<const std::byte> mapping);

    std::shared_ptr<TexelFile> file_;
    std::uint64_t position_; // in the file
    std::uint64_t forks_;    // of the process before the block was made
    std::span<const std::byte> mapping_;
};

} // namespace montelux
