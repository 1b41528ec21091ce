// Leafless for C++17: owners, spans, exceptions and lambdas around the functions of leafless.h.
//
// Generated from leafless.h; do not edit. SPDX-License-Identifier: MIT OR Apache-2.0
//
// Every function of the C interface is here under its own name: leafless_octree_statistics is a member of octree;
// leafless_octree_build, which makes an octree, is a static member. leafless.h documents the functions with their
// errors and threads. The functions are translated by these rules:
//
// - An object is a class that owns one reference. It moves; share() gives one more reference.
// - A function that fails throws leafless::error. With LEAFLESS_NO_EXCEPTIONS defined it returns a
//   leafless::result instead, which must be checked.
// - Results are returned; several results are a std::tuple in the order of the C function.
// - An input array is a leafless::span: of points (std::array<double, 3>), numbers or structs. An output array whose
//   length the caller knows, because there is one answer for each query, is a span that is filled.
// - An output array whose length only the library knows is returned as a std::vector. (It is filled in two calls.)
// - Texts are std::string_view. The result of a _peek function belongs to the object.
// - A parameter that may be NULL in C is a pointer here, with the default nullptr unless an argument without a default
//   follows.
// - Functions of the host are lambdas, or objects with members (solid_of, half_space_of, attribute_of, sink_to,
//   with_progress, at the end of this file). An exception in one of them ends the work. The exception is thrown again
//   by the leafless:: function that was called, and never unwinds the library itself.

#ifndef LEAFLESS_HPP
#define LEAFLESS_HPP

#include <leafless.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace leafless {

/// A point or a direction: x, y and z.
using point = std::array<double, 3>;

/// An affine map: three rows of four numbers, the last of which is the offset.
using affine = std::array<double, 12>;

/// A cell by its indices along x, y and z.
using cell_index = std::array<std::uint32_t, 3>;

/// A ray along an axis by its indices along the other two, in the order x, y, z.
using ray_index = std::array<std::uint32_t, 2>;

/// A view of contiguous elements, without ownership.
template <class T> class span {
public:
    constexpr span() noexcept = default;
    constexpr span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    /// All elements of a container that has data() and size().
    template <class C, class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<C &>().data()), T *>>>
    constexpr span(C &container) noexcept : data_(container.data()), size_(container.size()) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<const C &>().data()), T *>>>
    constexpr span(const C &container) noexcept : data_(container.data()), size_(container.size()) {}
    template <std::size_t N> constexpr span(T (&array)[N]) noexcept : data_(array), size_(N) {}
    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr T *begin() const noexcept { return data_; }
    constexpr T *end() const noexcept { return data_ + size_; }
    constexpr T &operator[](std::size_t i) const noexcept { return data_[i]; }

private:
    T *data_ = nullptr;
    std::size_t size_ = 0;
};

/// Returns the message of the last failure in the calling thread.
inline std::string last_message() {
    std::string message(leafless_last_error(nullptr, 0) + 1, '\0');
    leafless_last_error(message.data(), message.size());
    message.pop_back();
    return message;
}

#ifndef LEAFLESS_NO_EXCEPTIONS

/// The exception of a function that fails.
class error : public std::runtime_error {
public:
    error(leafless_status status, const std::string &message) : std::runtime_error(message), status_(status) {}
    leafless_status status() const noexcept { return status_; }

private:
    leafless_status status_;
};

#endif

namespace detail {

#ifndef LEAFLESS_NO_EXCEPTIONS

/// Exceptions of the host's functions, stored while control returns through the library, by the codes that the
/// functions returned.
///
/// Several threads of one operation may throw. The library reports the code of one exception; the others stay here
/// until the object that threw them is destroyed, or until newer ones need the room.
class exceptions {
public:
    /// Stores an exception and returns its code, which no function of the host returns otherwise. `owner` is the object
    /// that threw.
    static std::int32_t keep(const void *owner, std::exception_ptr exception) noexcept {
        try {
            exceptions &all = instance();
            const std::lock_guard<std::mutex> lock(all.mutex_);
            do {
                all.last_ = all.last_ == INT32_MIN ? -2 : all.last_ - 1;
            } while (all.kept_.count(all.last_) != 0);
            all.kept_.emplace(all.last_, thrown{std::move(exception), owner});
            // (An operation has 1024 threads at most. Numbers descend, so the first is the newest.)
            if (all.kept_.size() > 4096) all.kept_.erase(std::prev(all.kept_.end()));
            return all.last_;
        } catch (...) {
            return -1; // No memory: the exception is lost, but the failure is reported.
        }
    }

    static std::exception_ptr take(std::int32_t code) {
        exceptions &all = instance();
        const std::lock_guard<std::mutex> lock(all.mutex_);
        const auto found = all.kept_.find(code);
        if (found == all.kept_.end()) return nullptr;
        const std::exception_ptr exception = found->second.exception;
        all.kept_.erase(found);
        return exception;
    }

    /// Drops the exceptions that `owner` threw.
    static void forget(const void *owner) noexcept {
        exceptions &all = instance();
        const std::lock_guard<std::mutex> lock(all.mutex_);
        for (auto it = all.kept_.begin(); it != all.kept_.end();) {
            it = it->second.owner == owner ? all.kept_.erase(it) : std::next(it);
        }
    }

private:
    struct thrown {
        std::exception_ptr exception;
        const void *owner;
    };

    static exceptions &instance() {
        // It is never destroyed, because threads of the host may run until the program ends.
        static exceptions &all = *new exceptions;
        return all;
    }

    std::mutex mutex_;
    std::map<std::int32_t, thrown> kept_;
    std::int32_t last_ = -1;
};

/// Calls a function of the host and returns its result, or the code of its exception. `owner` is the object that has
/// it.
template <class F> std::int32_t guarded(const void *owner, F &&function) noexcept {
    try {
        return function();
    } catch (...) {
        return exceptions::keep(owner, std::current_exception());
    }
}

/// Drops the exceptions of an object, before it is destroyed.
inline void forget(const void *owner) noexcept { exceptions::forget(owner); }

/// Throws the exception for the last failure in the calling thread.
[[noreturn]] inline void raise(leafless_status status) {
    if (status == LEAFLESS_E_CALLBACK) {
        if (const std::exception_ptr exception = exceptions::take(leafless_last_code())) {
            std::rethrow_exception(exception);
        }
    }
    throw error(status, last_message());
}

/// Checks that arrays that belong together have the same size.
inline void same_size(std::size_t a, std::size_t b) {
    if (a != b) throw std::invalid_argument("arrays that belong together have different sizes");
}
inline void at_least(std::size_t least, std::size_t size) {
    if (size < least) throw std::invalid_argument("an array has no room for all answers");
}

#else

template <class F> std::int32_t guarded(const void *, F &&function) noexcept { return function(); }
inline void forget(const void *) noexcept {}
inline void same_size(std::size_t a, std::size_t b) {
    if (a != b) std::abort();
}
inline void at_least(std::size_t least, std::size_t size) {
    if (size < least) std::abort();
}

#endif

/// One reference to an object.
template <class H, void (*Free)(H *)> class owner {
public:
    owner() noexcept = default;
    explicit owner(H *handle) noexcept : handle_(handle) {}
    owner(owner &&other) noexcept : handle_(other.release()) {}
    owner &operator=(owner &&other) noexcept {
        if (this != &other) reset(other.release());
        return *this;
    }
    owner(const owner &) = delete;
    owner &operator=(const owner &) = delete;
    ~owner() { Free(handle_); }

    /// The handle, for functions of leafless.h. This object keeps the ownership.
    H *get() const noexcept { return handle_; }
    explicit operator bool() const noexcept { return handle_ != nullptr; }
    /// Returns the handle, which the caller must free.
    [[nodiscard]] H *release() noexcept { return std::exchange(handle_, nullptr); }
    void reset(H *handle = nullptr) noexcept { Free(std::exchange(handle_, handle)); }

private:
    H *handle_ = nullptr;
};

/// Returns the handle of an object that may be absent.
template <class T> auto handle_of(const T *object) noexcept { return object == nullptr ? nullptr : object->get(); }

/// Returns the address of the first number of an array whose elements have several numbers, such as points.
template <class T, std::size_t N> const T *numbers(const span<const std::array<T, N>> &array) noexcept {
    return array.size() == 0 ? nullptr : array.data()->data();
}
template <class T, std::size_t N> T *numbers(const span<std::array<T, N>> &array) noexcept {
    return array.size() == 0 ? nullptr : array.data()->data();
}
template <class T, std::size_t N> T *numbers(std::vector<std::array<T, N>> &array) noexcept {
    return array.empty() ? nullptr : array.data()->data();
}

/// Returns the numbers per value; the maximum, 4, if that is not available.
inline std::size_t components_of(const leafless_attribute *attribute) noexcept {
    leafless_attribute_info info = LEAFLESS_INIT(leafless_attribute_info);
    return leafless_attribute_describe(attribute, &info) == LEAFLESS_OK ? info.components : 4;
}
inline std::size_t components_of(const leafless_channel *channel) noexcept {
    leafless_channel_info info{};
    return leafless_channel_describe(channel, &info) == LEAFLESS_OK ? info.components : 4;
}

inline std::string_view text(const char *data, std::size_t size) noexcept {
    return data == nullptr ? std::string_view() : std::string_view(data, size);
}

} // namespace detail

#ifdef LEAFLESS_NO_EXCEPTIONS

/// The result of a function: a value, or the status of a failure.
template <class T> class [[nodiscard]] result {
public:
    result(leafless_status status, T value) : status_(status), value_(std::move(value)) {}
    leafless_status status() const noexcept { return status_; }
    explicit operator bool() const noexcept { return status_ == LEAFLESS_OK; }
    /// The value; meaningless after a failure.
    T &value() & noexcept { return value_; }
    T &&value() && noexcept { return std::move(value_); }

private:
    leafless_status status_;
    T value_;
};

template <> class [[nodiscard]] result<void> {
public:
    explicit result(leafless_status status) noexcept : status_(status) {}
    leafless_status status() const noexcept { return status_; }
    explicit operator bool() const noexcept { return status_ == LEAFLESS_OK; }

private:
    leafless_status status_;
};

template <class T> using returns = result<T>;

namespace detail {
template <class T> result<T> finish(leafless_status status, T value) { return result<T>(status, std::move(value)); }
inline result<void> finish(leafless_status status) { return result<void>(status); }
} // namespace detail

#else

/// The return type of a function.
template <class T> using returns = T;

namespace detail {
template <class T> T finish(leafless_status status, T value) {
    if (status != LEAFLESS_OK) raise(status);
    return value;
}
inline void finish(leafless_status status) {
    if (status != LEAFLESS_OK) raise(status);
}
} // namespace detail

#endif

/// Returns the handles of several objects, for functions that take any number: `refs(a, b, c)`.
template <class First, class... Rest> auto refs(const First &first, const Rest &...rest) {
    using handle = std::add_pointer_t<std::add_const_t<std::remove_pointer_t<decltype(first.get())>>>;
    return std::array<handle, 1 + sizeof...(rest)>{{first.get(), rest.get()...}};
}

/// Returns the handles of a list of objects.
template <class T> auto refs(const std::vector<T> &objects) {
    std::vector<std::add_pointer_t<std::add_const_t<std::remove_pointer_t<decltype(objects[0].get())>>>> handles;
    handles.reserve(objects.size());
    for (const T &object : objects) handles.push_back(object.get());
    return handles;
}
