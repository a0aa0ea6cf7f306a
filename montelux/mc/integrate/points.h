// Batches of points and values, coordinate by coordinate, which estimators pass to integrands.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace montelux {

// A view of `count` points of `dimensions` coordinates; coordinate d of all points is contiguous (structure
// of arrays), so that loops over the points vectorise.
class PointBatch {
  public:
    PointBatch(const double* data, std::size_t count, int dimensions, std::size_t stride)
        : data_(data), count_(count), stride_(stride), dimensions_(dimensions) {}

    std::size_t count() const { return count_; }
    int dimensions() const { return dimensions_; }
    // Coordinate d of every point.
    std::span<const double> coordinate(int d) const {
        return {data_ + static_cast<std::size_t>(d) * stride_, count_};
    }
    double operator()(std::size_t point, int d) const {
        return data_[static_cast<std::size_t>(d) * stride_ + point];
    }
    // The coordinates of one point; `x` has room for `dimensions` numbers.
    void gather(std::size_t point, double* x) const {
        const double* at = data_ + point;
        for (int d = 0; d < dimensions_; ++d, at += stride_) x[d] = *at;
    }
    // Points [first, first + count).
    PointBatch slice(std::size_t first, std::size_t count) const {
        return {data_ + first, count, dimensions_, stride_};
    }
    const double* data() const { return data_; }
    // Distance between the coordinates of a point.
    std::size_t stride() const { return stride_; }

  private:
    const double* data_;
    std::size_t count_, stride_;
    int dimensions_;
};

// std::allocator without zeroing: the numbers are written before they are read.
template <typename T>
struct UninitialisedAllocator : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = UninitialisedAllocator<U>;
    };
    template <typename U, typename... Args>
    void construct(U* at, Args&&... args) {
        if constexpr (sizeof...(Args) == 0)
            ::new (static_cast<void*>(at)) U;
        else
            ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
    }
};

// Owns the coordinates of a batch of points.
class PointBuffer {
  public:
    PointBuffer() = default;
    PointBuffer(std::size_t count, int dimensions) { resize(count, dimensions); }

    // Old contents are lost; memory never shrinks, so that a buffer can be used again and again.
    void resize(std::size_t count, int dimensions) {
        count_ = count;
        dimensions_ = dimensions;
        std::size_t size = count * static_cast<std::size_t>(dimensions);
        if (data_.size() < size) data_.resize(size);
    }
    std::size_t count() const { return count_; }
    int dimensions() const { return dimensions_; }
    std::span<double> coordinate(int d) {
        return {data_.data() + static_cast<std::size_t>(d) * count_, count_};
    }
    double& operator()(std::size_t point, int d) {
        return data_[static_cast<std::size_t>(d) * count_ + point];
    }
    PointBatch view() const { return {data_.data(), count_, dimensions_, count_}; }
    operator PointBatch() const { return view(); }

  private:
    std::vector<double, UninitialisedAllocator<double>> data_;
    std::size_t count_ = 0;
    int dimensions_ = 0;
};

// The values of an integrand at a batch of points: component c of all points is contiguous.
class ValueBatch {
  public:
    ValueBatch(double* data, std::size_t count, int components, std::size_t stride)
        : data_(data), count_(count), stride_(stride), components_(components) {}

    std::size_t count() const { return count_; }
    int components() const { return components_; }
    // Component c at every point.
    std::span<double> component(int c) const {
        return {data_ + static_cast<std::size_t>(c) * stride_, count_};
    }
    double& operator()(std::size_t point, int c = 0) const {
        return data_[static_cast<std::size_t>(c) * stride_ + point];
    }
    // Distance between the components of a value.
    std::size_t stride() const { return stride_; }
    // Those of points [first, first + count).
    ValueBatch slice(std::size_t first, std::size_t count) const {
        return {data_ + first, count, components_, stride_};
    }

  private:
    double* data_;
    std::size_t count_, stride_;
    int components_;
};

// Owns the values of a batch.
class ValueBuffer {
  public:
    ValueBuffer() = default;
    ValueBuffer(std::size_t count, int components) { resize(count, components); }

    // Old contents are lost.
    void resize(std::size_t count, int components) {
        count_ = count;
        components_ = components;
        std::size_t size = count * static_cast<std::size_t>(components);
        if (data_.size() < size) data_.resize(size);
    }
    std::size_t count() const { return count_; }
    int components() const { return components_; }
    std::span<const double> component(int c = 0) const {
        return {data_.data() + static_cast<std::size_t>(c) * count_, count_};
    }
    std::span<double> component(int c = 0) { return view().component(c); }
    double operator()(std::size_t point, int c = 0) const {
        return data_[static_cast<std::size_t>(c) * count_ + point];
    }
    ValueBatch view() { return {data_.data(), count_, components_, count_}; }
    operator ValueBatch() { return view(); }

  private:
    std::vector<double, UninitialisedAllocator<double>> data_;
    std::size_t count_ = 0;
    int components_ = 0;
};

} // namespace montelux
