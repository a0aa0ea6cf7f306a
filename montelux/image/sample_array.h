// SampleArray: the samples of an image, in memory or in a block of a TexelFile.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace montelux {

class TexelBlock;
class TexelFile;

// A copy of an array in a file refers to the same block. To be written it is brought into memory first.
template <typename T>
class SampleArray {
  public:
    SampleArray() = default;
    SampleArray(const SampleArray& other) : own_(other.own_), block_(other.block_) { locate(); }
    SampleArray(SampleArray&& other) noexcept { *this = std::move(other); }
    SampleArray& operator=(const SampleArray& other) { return *this = SampleArray(other); }
    SampleArray& operator=(SampleArray&& other) noexcept {
        own_ = std::exchange(other.own_, {});
        block_ = std::exchange(other.block_, nullptr);
        data_ = std::exchange(other.data_, nullptr);
        size_ = std::exchange(other.size_, 0);
        return *this;
    }
    ~SampleArray() = default;

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    std::span<const T> span() const { return {data_, size_}; }
    std::span<T> writable() {
        if (block_) load();
        return own_;
    }
    void resize(std::size_t size);

    void move_to(TexelFile& file);
    // Null: the array is in memory.
    const std::shared_ptr<TexelBlock>& block() const { return block_; }

  private:
    void load();
    void locate();

    std::vector<T> own_;
    std::shared_ptr<TexelBlock> block_;
    const T* data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace montelux
