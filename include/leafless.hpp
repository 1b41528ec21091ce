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

class control;
class mesh;
class solid;
class volume;
class scene;
class octree;
class point_cursor;
class point_table;
class cursor;
class cells;
class faces;
class columns;
class bay;
class layout;
class lazy;
class attribute;
class channel;
class boundary;
class tridexel;
class tridexel_editor;
class layer;

/// A leafless_control.
class control : public detail::owner<leafless_control, leafless_control_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::control> make();
    returns<void> cancel() const;
    returns<void> reset() const;
    [[nodiscard]] returns<std::tuple<bool, double>> state() const;
};

/// A leafless_mesh.
class mesh : public detail::owner<leafless_mesh, leafless_mesh_free> {
public:
    using owner::owner;
    [[nodiscard]] returns<leafless::mesh> share() const;
    [[nodiscard]] returns<leafless_mesh_info> describe() const;
    returns<void> copy(span<point> vertices, span<cell_index> triangles) const;
    [[nodiscard]] returns<std::vector<point>> normals() const;
    [[nodiscard]] returns<std::tuple<point, point>> bounds() const;
    [[nodiscard]] returns<double> volume() const;
    [[nodiscard]] returns<double> area() const;
    [[nodiscard]] returns<leafless_mesh_report> inspect() const;
    [[nodiscard]] returns<std::vector<leafless_mesh_defect>> defects(uint64_t limit) const;
    returns<void> check_closed(leafless_fill fill) const;
    [[nodiscard]] returns<leafless::mesh> sewn() const;
    [[nodiscard]] returns<leafless::mesh> with_deviation(double deviation_model) const;
    [[nodiscard]] returns<leafless::mesh> transformed(const affine &matrix) const;
    [[nodiscard]] returns<leafless::mesh> translated(const point &offset_model) const;
    [[nodiscard]] static returns<leafless::mesh> make(const leafless_mesh_arrays &arrays);
    [[nodiscard]] static returns<std::tuple<double,
        leafless::mesh>> from_polyhedron(const leafless_polyhedron_arrays &arrays);
    [[nodiscard]] returns<leafless_mesh_moments> measure(leafless_fill fill,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::tuple<std::vector<leafless_intersecting_pair>,
        bool>> intersecting_pairs(const leafless_options *options = nullptr) const;
    [[nodiscard]] static returns<std::tuple<leafless_mesh_file_info,
        leafless::mesh>> read(const leafless_source &source, const leafless_mesh_options &options);
    [[nodiscard]] returns<std::tuple<uint64_t, std::string_view>> peek_warning_at(uint64_t index) const;
    returns<void> write(const leafless_mesh_write_options &options, const leafless_sink &sink) const;
    [[nodiscard]] returns<std::tuple<leafless_single_precision,
        leafless::mesh>> in_single_precision(double tolerance_model,
        const leafless_options *options = nullptr) const;
    static returns<void> write_polygons(const leafless_polyhedron_arrays &arrays,
        const leafless_mesh_write_options &options, const leafless_sink &sink);
    [[nodiscard]] returns<leafless::mesh> written_form(const leafless_mesh_write_options &options) const;
    [[nodiscard]] returns<std::tuple<uint64_t, std::string_view, uint32_t,
        bool>> peek_attribute_at(uint64_t index) const;
    [[nodiscard]] returns<std::tuple<uint64_t, std::string_view>> peek_attribute_name_at(uint64_t index,
        uint64_t value) const;
    [[nodiscard]] returns<std::vector<double>> attribute_values(uint64_t index) const;
    [[nodiscard]] returns<std::vector<uint32_t>> bodies() const;
    [[nodiscard]] returns<leafless::mesh> with_values(const leafless::attribute &attribute,
        std::string_view name, double depth_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::tuple<leafless_simplified, leafless::mesh>> simplify(double tolerance_model,
        const leafless_options *options = nullptr) const;
};

/// A leafless_solid.
class solid : public detail::owner<leafless_solid, leafless_solid_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::solid> from_mesh(const leafless::mesh &mesh, leafless_fill fill);
    [[nodiscard]] static returns<leafless::solid> from_octree(const leafless::octree &octree);
    [[nodiscard]] returns<leafless_solid_info> describe() const;
    [[nodiscard]] returns<leafless::solid> share() const;
    [[nodiscard]] static returns<leafless::solid> new_ball(const point &centre_model, double radius_model);
    [[nodiscard]] static returns<leafless::solid> new_box(const point &min_model, const point &max_model);
    [[nodiscard]] static returns<leafless::solid> new_halfspace(const point &normal, double offset);
    [[nodiscard]] static returns<leafless::solid> new_quadric(const std::array<double,10> &coefficients);
    [[nodiscard]] static returns<leafless::solid> new_ellipsoid(const point &centre_model,
        const point &radii_model, const affine *matrix = nullptr);
    [[nodiscard]] static returns<leafless::solid> new_cylinder(const point &from_model, const point &to_model,
        double radius_model);
    [[nodiscard]] static returns<leafless::solid> new_frustum(const point &from_model, const point &to_model,
        double from_radius_model, double to_radius_model);
    [[nodiscard]] static returns<leafless::solid> new_power(const point &coefficients,
        const point &centre_model, const cell_index &exponents, double constant);
    [[nodiscard]] static returns<leafless::solid> new_torus(const point &centre_model, const point &axis,
        double major_model, double minor_model);
    [[nodiscard]] static returns<leafless::solid> new_wedge(const point &size_model, double top_model,
        const affine *matrix = nullptr);
    [[nodiscard]] static returns<leafless::solid> new_prism(span<const std::array<double,2>> polygon_model,
        double low_model, double high_model, const affine *matrix = nullptr);
    [[nodiscard]] static returns<leafless::solid> new_convex(span<const std::array<double,4>> planes);
    [[nodiscard]] static returns<leafless::solid> combine(leafless_operation operation,
        span<const leafless_solid *const> solids);
    [[nodiscard]] returns<leafless::solid> complement() const;
    [[nodiscard]] returns<std::tuple<leafless_motion, leafless::solid>> placed(const affine &matrix) const;
    [[nodiscard]] returns<leafless::solid> adaptive(double tolerance_model) const;
    [[nodiscard]] returns<leafless::solid> with_touch(leafless_touch touch) const;
    [[nodiscard]] static returns<leafless::solid> new_callbacks(const leafless_solid_callbacks &callbacks);
    [[nodiscard]] static returns<leafless::solid> new_function(const leafless_solid_function &function);
    [[nodiscard]] static returns<leafless::solid> from_volume(const leafless::volume &volume,
        const leafless_interval *band = nullptr, const leafless_options *options = nullptr);
    [[nodiscard]] static returns<leafless::solid> from_scene(const leafless::scene &scene,
        const leafless_frame &frame);
    [[nodiscard]] static returns<leafless::solid> from_shards(const leafless::octree &top, uint32_t level,
        span<const uint64_t> codes, span<const leafless_octree *const> octrees);
    returns<void> contains_many(const leafless_frame &frame, span<const point> points_model,
        const leafless_options *options, span<leafless_membership> memberships) const;
    [[nodiscard]] returns<leafless_region> classify_box(const leafless_frame &frame, const point &min_model,
        const point &max_model, const leafless_options *options = nullptr) const;
    returns<void> cast_rays(const leafless_frame &frame, span<const leafless_ray> rays, leafless_obstacle on,
        const leafless_options *options, span<leafless_ray_hit> hits) const;
    [[nodiscard]] returns<std::tuple<std::vector<leafless_interval>,
        std::vector<leafless_interval>>> ray_spans(const leafless_frame &frame, const leafless_ray &ray,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_sight> line_of_sight(const leafless_frame &frame, const point &from_model,
        const point &to_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::columns> columns(const leafless_frame &frame, uint32_t axis,
        const ray_index *first = nullptr, const ray_index *end = nullptr,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::vector<leafless_interval>> heights(const leafless_frame &frame, uint32_t axis,
        const ray_index *first, const ray_index *end, leafless_side side,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_region> classify_in(const leafless::solid &region,
        const leafless_frame &frame, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_cells_in> cells_in(const leafless::solid &region,
        const leafless_frame &frame, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_interval> volume_in(const leafless::solid &region,
        const leafless_frame &frame, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_measures> measure(const leafless_frame &frame, double relative,
        double absolute_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_surface_area> surface_area(const leafless_frame &frame, double relative,
        double absolute_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_section_area> section_area(const leafless_frame &frame,
        const point &point_model, const point &normal, double relative, double absolute_model,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_extent> bounding_box(const leafless_frame &frame, double tolerance_model,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_mass_sum> measure_cell(const leafless_frame &frame, uint32_t level,
        uint64_t code, double relative, double absolute_model,
        const leafless_options *options = nullptr) const;
    returns<void> distances(const leafless_frame &frame, span<const point> points_model,
        leafless_distance_to to, double tolerance_model, const leafless_options *options,
        span<leafless_point_distance> distances) const;
    [[nodiscard]] returns<leafless::solid> transformed(const leafless_frame &own, const affine &matrix) const;
    [[nodiscard]] returns<leafless::solid> resampled(const leafless_frame &own, const affine &matrix) const;
    [[nodiscard]] returns<leafless_interference> interfere(const leafless::solid &b,
        const leafless_frame &frame, double tolerance_model, const leafless_options *options = nullptr) const;
    returns<void> interfere_many(const leafless::solid &b, const leafless_frame &own,
        span<const affine> matrices, const leafless_frame &frame, double tolerance_model,
        const leafless_options *options, span<leafless_interference> interferences) const;
    [[nodiscard]] returns<leafless_clearance> clearance(const leafless::solid &b, const leafless_frame &frame,
        double tolerance_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_gap> gap_at_least(const leafless::solid &b, const leafless_frame &frame,
        double least_model, const leafless_options *options = nullptr) const;
    returns<void> clearance_many(const leafless::solid &b, const leafless_frame &own,
        span<const affine> matrices, const leafless_frame &frame, double tolerance_model,
        const leafless_options *options, span<leafless_placed_clearance> clearances) const;
    returns<void> gap_at_least_many(const leafless::solid &b, const leafless_frame &own,
        span<const affine> matrices, const leafless_frame &frame, double least_model,
        const leafless_options *options, span<leafless_placed_gap> gaps) const;
    [[nodiscard]] returns<leafless_deviation> deviation(const leafless::solid &b, const leafless_frame &frame,
        double tolerance_model, double within_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::vector<leafless_material>> materials(const leafless::channel &channel,
        const leafless_frame &frame, double relative, double absolute_model,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::mesh> surface(const leafless_frame &frame,
        const leafless_surface_options *surface = nullptr, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::boundary> boundary(const leafless_frame &frame, double tolerance_model,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::tuple<leafless_contour_report,
        leafless::mesh>> contour(const leafless_frame &frame, double tolerance_model,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] static returns<leafless::solid> from_tridexel(const leafless::tridexel &tridexel,
        bool is_truth, const leafless_options *options = nullptr);
};

/// A leafless_volume.
class volume : public detail::owner<leafless_volume, leafless_volume_free> {
public:
    using owner::owner;
    [[nodiscard]] returns<leafless::volume> share() const;
    [[nodiscard]] returns<leafless_volume_info> describe() const;
    [[nodiscard]] returns<uint64_t> peek_samples(const void **samples) const;
    [[nodiscard]] returns<leafless_frame> frame() const;
    [[nodiscard]] returns<std::tuple<point, point>> bounds() const;
    [[nodiscard]] returns<leafless_interval> range(const leafless_options *options = nullptr) const;
    [[nodiscard]] static returns<leafless::volume> make(const leafless_volume_layout &layout,
        const leafless_source &source);
    [[nodiscard]] static returns<leafless::volume> read(const leafless_source &source,
        const leafless_source &data);
    [[nodiscard]] static returns<std::vector<char>> data_file(span<const uint8_t> bytes);
    returns<void> write(leafless_volume_format format, const leafless_sink &sink) const;
    [[nodiscard]] returns<leafless::mesh> surface(const leafless_interval *band = nullptr,
        const leafless_options *options = nullptr) const;
};

/// A leafless_scene.
class scene : public detail::owner<leafless_scene, leafless_scene_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::scene> read(const leafless_source &source,
        const leafless_scene_options &options);
    [[nodiscard]] returns<leafless_scene_info> describe() const;
    [[nodiscard]] returns<std::tuple<leafless_scene_mesh_info,
        leafless_mesh_report>> describe_mesh_at(uint64_t index) const;
    [[nodiscard]] returns<std::vector<uint8_t>> mesh_file_at(uint64_t index) const;
    [[nodiscard]] returns<leafless::scene> share() const;
    [[nodiscard]] returns<std::tuple<point, point>> bounds() const;
};

/// A leafless_octree.
class octree : public detail::owner<leafless_octree, leafless_octree_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::octree> new_uniform(const leafless_frame &frame, leafless_tag tag,
        leafless_tag exterior);
    [[nodiscard]] returns<leafless::octree> share() const;
    [[nodiscard]] returns<leafless_octree_info> describe() const;
    [[nodiscard]] returns<leafless::octree> with_proof(leafless_proven proven,
        double displacement_model) const;
    [[nodiscard]] returns<leafless_statistics> statistics() const;
    [[nodiscard]] returns<std::vector<leafless_statistics>> levels() const;
    returns<void> check() const;
    [[nodiscard]] returns<bool> equal(const leafless::octree &b) const;
    [[nodiscard]] returns<leafless::octree> with_metadata(std::string_view key, std::string_view value) const;
    [[nodiscard]] returns<leafless::octree> without_metadata(std::string_view key) const;
    [[nodiscard]] returns<std::string_view> peek_metadata(std::string_view key) const;
    [[nodiscard]] returns<std::tuple<uint64_t, std::string_view,
        std::string_view>> peek_metadata_at(uint64_t index) const;
    [[nodiscard]] static returns<leafless::octree> build(const leafless::solid &solid,
        const leafless_frame &frame, leafless_rule rule, const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::octree> resolve(leafless_rule rule,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::octree> compact() const;
    [[nodiscard]] static returns<leafless::octree> combine(leafless_operation operation,
        span<const leafless_octree *const> octrees, const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::octree> complement(const leafless_options *options = nullptr) const;
    [[nodiscard]] static returns<leafless::octree> build_extended(const leafless::solid &solid,
        const leafless_frame &frame, const leafless_cut_options *cuts = nullptr,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::octree> plain(uint32_t depth, leafless_rule rule,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_cut_counts> count_cuts() const;
    [[nodiscard]] returns<leafless_stored_surface_info> surface_at(uint32_t surface, span<double> terms,
        span<double> placements) const;
    [[nodiscard]] returns<leafless_cell_function> cell_function(uint32_t level, const cell_index &cell) const;
    [[nodiscard]] static returns<leafless::octree> build_shard(const leafless::solid &solid,
        const leafless_frame &frame, leafless_rule rule, const leafless_shard &shard,
        const leafless_options *options = nullptr);
    [[nodiscard]] static returns<leafless::octree> build_extended_shard(const leafless::solid &solid,
        const leafless_frame &frame, const leafless_cut_options *cuts, const leafless_shard &shard,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::octree> shard(const leafless_shard &shard,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] static returns<leafless::octree> join(span<const leafless_octree *const> octrees,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<std::vector<uint64_t>> open_cells(uint32_t level) const;
    [[nodiscard]] returns<std::vector<leafless_statistics>> statistics_with(uint32_t level,
        span<const uint64_t> codes, span<const leafless_statistics> levels) const;
    [[nodiscard]] returns<leafless_membership> contains(const point &point_model) const;
    returns<void> contains_many(span<const point> points_model, span<leafless_membership> memberships) const;
    [[nodiscard]] returns<leafless_tag> tag_at(const cell_index &cell) const;
    [[nodiscard]] returns<leafless_region> classify_box(const point &min_model, const point &max_model) const;
    [[nodiscard]] returns<std::tuple<std::vector<uint64_t>, std::vector<uint64_t>>> bitmap(uint32_t level,
        const cell_index &min_cell, const cell_index &max_cell,
        const leafless_options *options = nullptr) const;
    returns<void> cast_rays(span<const leafless_ray> rays, leafless_obstacle on,
        span<leafless_ray_hit> hits) const;
    [[nodiscard]] returns<std::tuple<std::vector<leafless_interval>,
        std::vector<leafless_interval>>> ray_spans(const leafless_ray &ray) const;
    [[nodiscard]] returns<leafless::columns> columns(uint32_t axis, const ray_index *first = nullptr,
        const ray_index *end = nullptr) const;
    [[nodiscard]] returns<std::vector<leafless_interval>> heights(uint32_t axis, const ray_index *first,
        const ray_index *end, leafless_side side) const;
    [[nodiscard]] returns<std::tuple<uint64_t, uint64_t>> cells_in_box(const cell_index &min_cell,
        const cell_index &max_cell) const;
    [[nodiscard]] returns<leafless_interval> volume_in_box(const point &min_model,
        const point &max_model) const;
    [[nodiscard]] returns<leafless_cells_in> cells_in(const leafless::solid &region,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_interval> volume_in(const leafless::solid &region,
        const leafless_options *options = nullptr) const;
    returns<void> distances(span<const point> points_model, leafless_distance_to to,
        const leafless_options *options, span<leafless_interval> distances_model) const;
    [[nodiscard]] returns<std::vector<leafless_near_cell>> nearest_cells(const point &point_model,
        uint32_t tags) const;
    returns<void> distance_field(const cell_index &min_cell, const cell_index &max_cell,
        const leafless_options *options, span<float> field) const;
    [[nodiscard]] returns<leafless::octree> with_channel(const leafless::channel &channel) const;
    [[nodiscard]] returns<leafless::octree> without_channel(std::string_view name) const;
    [[nodiscard]] returns<leafless::channel> channel_at(uint64_t index) const;
    [[nodiscard]] returns<leafless::channel> channel(std::string_view name) const;
    [[nodiscard]] returns<leafless::octree> carry_channels(span<const leafless_octree *const> operands,
        leafless_carry carry, span<const leafless_carry_rule> rules,
        const leafless_options *options = nullptr) const;
    returns<void> voxels(const leafless_voxel_options *voxel_options, const leafless_options *options,
        leafless_frame *lattice, uint64_t *codes, uint8_t *levels, leafless_voxel_kind *kinds,
        double *corners_model, double *values, uint64_t capacity, uint64_t *count) const;
    [[nodiscard]] static returns<leafless::octree> from_voxels(const leafless_frame &lattice,
        const uint64_t *codes, const uint8_t *levels, span<const leafless_voxel_kind> kinds,
        leafless_tag boundary, const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::mesh> surface(const leafless_surface_options *surface = nullptr,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] static returns<leafless::octree> from_tridexel(const leafless::tridexel &tridexel,
        const leafless_options *options = nullptr);
    [[nodiscard]] static returns<leafless::octree> from_tridexel_ends(const leafless::tridexel &tridexel,
        const leafless_options *options = nullptr);
    [[nodiscard]] static returns<leafless::octree> read(const leafless_source &source);
    returns<void> write(const leafless_sink &sink) const;
};

/// A leafless_point_cursor.
class point_cursor : public detail::owner<leafless_point_cursor, leafless_point_cursor_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::point_cursor> make(const leafless::octree &octree);
    returns<leafless_membership> contains(const point &point_model);
    returns<leafless_tag> tag_at(const cell_index &cell);
};

/// A leafless_point_table.
class point_table : public detail::owner<leafless_point_table, leafless_point_table_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<std::tuple<leafless::point_table,
        uint8_t>> make(const leafless::octree &octree, uint8_t level);
    [[nodiscard]] returns<leafless_membership> contains(const point &point_model) const;
    returns<void> contains_many(span<const point> points_model, span<leafless_membership> memberships) const;
};

/// A leafless_cursor.
class cursor : public detail::owner<leafless_cursor, leafless_cursor_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::cursor> make(const leafless::octree &octree);
    [[nodiscard]] returns<leafless_cursor_info> describe() const;
    returns<bool> descend(uint32_t octant);
    returns<bool> ascend();
    returns<bool> seek(const cell_index &cell, uint32_t level);
    [[nodiscard]] returns<std::tuple<leafless_cell,
        bool>> neighbour(const std::array<int32_t,3> &direction) const;
    [[nodiscard]] returns<std::vector<leafless_cell>> neighbours(const std::array<int32_t,3> &direction) const;
};

/// A leafless_cells.
class cells : public detail::owner<leafless_cells, leafless_cells_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::cells> make(const leafless::octree &octree, uint32_t tags,
        uint32_t min_level, uint32_t max_level, const cell_index *min_cell = nullptr,
        const cell_index *max_cell = nullptr);
    returns<void> seek(const cell_index &cell, uint32_t level);
    returns<uint64_t> next(span<leafless_cell> buffer);
};

/// A leafless_faces.
class faces : public detail::owner<leafless_faces, leafless_faces_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::faces> make(const leafless::octree &octree, uint32_t tags,
        uint32_t min_level, uint32_t max_level, const cell_index *min_cell = nullptr,
        const cell_index *max_cell = nullptr);
    returns<void> seek(const cell_index &cell, uint32_t level);
    returns<uint64_t> next(span<leafless_boundary_face> buffer);
};

/// A leafless_columns.
class columns : public detail::owner<leafless_columns, leafless_columns_free> {
public:
    using owner::owner;
    [[nodiscard]] returns<std::tuple<std::vector<uint64_t>,
        std::vector<leafless_run>>> copy(leafless_obstacle on) const;
};

/// A leafless_bay.
class bay : public detail::owner<leafless_bay, leafless_bay_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::bay> make(const leafless::solid &container, double clearance_model,
        double wall_clearance_model);
    returns<uint64_t> add_obstacle(const leafless::solid &solid);
    returns<uint64_t> add_item(const leafless::solid &solid, uint32_t count,
        const leafless_item_options *item = nullptr);
};

/// A leafless_layout.
class layout : public detail::owner<leafless_layout, leafless_layout_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::layout> make(const leafless::bay &bay,
        const leafless_options *options = nullptr);
    returns<uint64_t> place(uint64_t item, const affine &matrix);
    returns<void> move_to(uint64_t number, const affine &matrix);
    returns<void> remove(uint64_t number);
    [[nodiscard]] returns<std::vector<leafless_placement>> placements() const;
    [[nodiscard]] returns<leafless_placement> placement_at(uint64_t number) const;
    [[nodiscard]] returns<leafless_standing> check(uint64_t number, const leafless_options *options,
        span<leafless_neighbour> conflicts) const;
    [[nodiscard]] returns<std::vector<leafless_placed_standing>> check_all(const leafless_options *options = nullptr) const;
    returns<leafless_search_report> search(const leafless_search_options *search = nullptr,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless_layout_measures> measure(double relative,
        const leafless_options *options = nullptr) const;
};

/// A leafless_lazy.
class lazy : public detail::owner<leafless_lazy, leafless_lazy_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::lazy> make(const leafless::solid &solid,
        const leafless_frame &frame);
    [[nodiscard]] static returns<leafless::lazy> resume(const leafless::octree &octree,
        const leafless::solid &solid, const leafless_frame &frame, const leafless_options *options = nullptr);
    returns<std::array<leafless_tag,8>> split(const cell_index &cell, uint32_t level);
    returns<bool> refine(const leafless_zone *zone, uint32_t level,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<std::tuple<leafless_tag, bool>> tag_at(const cell_index &cell,
        uint32_t level) const;
    [[nodiscard]] returns<leafless_membership> contains(const point &point_model) const;
    [[nodiscard]] returns<leafless_lazy_info> describe() const;
    [[nodiscard]] returns<std::vector<leafless_statistics>> levels() const;
    [[nodiscard]] returns<std::vector<uint64_t>> splits() const;
    [[nodiscard]] returns<leafless::octree> freeze(const leafless_options *options = nullptr) const;
};

/// A leafless_attribute.
class attribute : public detail::owner<leafless_attribute, leafless_attribute_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::attribute> new_constant(const double *value, uint32_t components);
    [[nodiscard]] returns<leafless::attribute> placed(const affine &matrix) const;
    [[nodiscard]] returns<leafless_attribute_info> describe() const;
    returns<void> values(span<const point> points_model, span<double> values) const;
    [[nodiscard]] returns<leafless_value_range> range(const point &min_model, const point &max_model) const;
    [[nodiscard]] returns<leafless::attribute> share() const;
    [[nodiscard]] static returns<leafless::attribute> new_callbacks(const leafless_attribute_callbacks &callbacks);
    [[nodiscard]] static returns<leafless::attribute> from_mesh(const leafless::mesh &mesh,
        std::string_view name);
    [[nodiscard]] static returns<leafless::attribute> from_mesh_values(const leafless::mesh &mesh,
        span<const double> values, uint32_t components, bool per_corner);
    [[nodiscard]] static returns<leafless::attribute> from_channel(const leafless::channel &channel);
    [[nodiscard]] static returns<leafless::attribute> from_volume(const leafless::volume &volume,
        leafless_interpolation interpolation, const leafless_options *options = nullptr);
};

/// A leafless_channel.
class channel : public detail::owner<leafless_channel, leafless_channel_free> {
public:
    using owner::owner;
    [[nodiscard]] returns<leafless::channel> share() const;
    [[nodiscard]] returns<leafless_channel_info> describe() const;
    returns<void> check() const;
    [[nodiscard]] returns<bool> equal(const leafless::channel &b) const;
    [[nodiscard]] returns<leafless::channel> with_metadata(std::string_view key,
        std::string_view value) const;
    [[nodiscard]] returns<leafless::channel> without_metadata(std::string_view key) const;
    [[nodiscard]] returns<std::string_view> peek_metadata(std::string_view key) const;
    [[nodiscard]] returns<std::tuple<uint64_t, std::string_view,
        std::string_view>> peek_metadata_at(uint64_t index) const;
    [[nodiscard]] static returns<leafless::channel> fill(const leafless::attribute &attribute,
        const leafless_frame &frame, const leafless_channel_fill_options *fill = nullptr,
        const leafless_options *options = nullptr);
    returns<void> values(span<const point> points_model, span<double> values) const;
    [[nodiscard]] returns<std::array<double,4>> value(const point &point_model) const;
    [[nodiscard]] returns<std::array<double,4>> value_at(const cell_index &cell) const;
    [[nodiscard]] returns<leafless::channel> with_value_in(const leafless::octree &region,
        const double *value, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless_channel_summary> summarise(const leafless::octree *solid,
        const point &min_model, const point &max_model, const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::octree> region(const double *low, const double *high,
        const leafless_options *options = nullptr) const;
};

/// A leafless_boundary.
class boundary : public detail::owner<leafless_boundary, leafless_boundary_free> {
public:
    using owner::owner;
    [[nodiscard]] returns<leafless::boundary> share() const;
    [[nodiscard]] returns<leafless_boundary_report> describe() const;
    [[nodiscard]] returns<leafless::mesh> mesh() const;
    [[nodiscard]] returns<std::vector<leafless_boundary_surface>> surfaces() const;
    [[nodiscard]] returns<std::vector<leafless_boundary_region>> regions() const;
    [[nodiscard]] returns<std::vector<uint32_t>> triangle_regions() const;
    [[nodiscard]] returns<leafless_polyhedron_arrays> peek_faces() const;
};

/// A leafless_tridexel.
class tridexel : public detail::owner<leafless_tridexel, leafless_tridexel_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::tridexel> build(const leafless::solid &solid,
        const leafless_frame &frame, leafless_rule rule, const leafless_tridexel_format *format = nullptr,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::tridexel> share() const;
    [[nodiscard]] returns<leafless_tridexel_info> describe() const;
    returns<void> check() const;
    [[nodiscard]] returns<bool> equal(const leafless::tridexel &b) const;
    [[nodiscard]] returns<leafless::tridexel> with_metadata(std::string_view key,
        std::string_view value) const;
    [[nodiscard]] returns<leafless::tridexel> without_metadata(std::string_view key) const;
    [[nodiscard]] returns<std::string_view> peek_metadata(std::string_view key) const;
    [[nodiscard]] returns<std::tuple<uint64_t, std::string_view,
        std::string_view>> peek_metadata_at(uint64_t index) const;
    [[nodiscard]] static returns<leafless::tridexel> make(const leafless_frame &frame,
        const leafless_tridexel_format *format, span<const leafless_tridexel_arrays> rays,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless_dexel_statistics> statistics(uint32_t axis) const;
    [[nodiscard]] returns<bool> contains_cell(const cell_index &cell) const;
    [[nodiscard]] returns<std::tuple<ray_index, ray_index>> window(uint32_t axis) const;
    [[nodiscard]] returns<std::vector<leafless_dexel>> ray(uint32_t axis,
        const ray_index *ray = nullptr) const;
    returns<void> copy(uint32_t axis, const uint32_t *first, const uint32_t *end, uint64_t *offsets,
        uint64_t offset_capacity, uint64_t *offset_count, double *ends_model, double *normals,
        uint32_t *surfaces, uint32_t *materials, uint64_t interval_capacity, uint64_t *interval_count) const;
    [[nodiscard]] returns<std::vector<std::array<double,2>>> copy_cells(uint32_t axis,
        const ray_index *first = nullptr, const ray_index *end = nullptr) const;
    [[nodiscard]] static returns<leafless::tridexel> combine(leafless_operation operation,
        span<const leafless_tridexel *const> tridexels, const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::tridexel> complement(const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::tridexel> with_format(const leafless_tridexel_format *format = nullptr,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<leafless::tridexel> with_material(uint32_t material,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::tuple<leafless_dexel_surface_report,
        leafless::mesh>> surface(leafless_dexel_surface_method method,
        const leafless_options *options = nullptr) const;
    [[nodiscard]] returns<std::vector<leafless_long_voxel>> voxels(const leafless_options *options,
        span<const std::array<uint8_t,4>> colours) const;
    [[nodiscard]] static returns<leafless::tridexel> read(const leafless_source &source);
    returns<void> write(const leafless_sink &sink) const;
};

/// A leafless_tridexel_editor.
class tridexel_editor : public detail::owner<leafless_tridexel_editor, leafless_tridexel_editor_free> {
public:
    using owner::owner;
    [[nodiscard]] static returns<leafless::tridexel_editor> make(const leafless::tridexel &tridexel);
    [[nodiscard]] returns<leafless_tridexel_info> describe() const;
    returns<leafless_dexel_change> combine(leafless_operation operation, const leafless::tridexel &tridexel,
        const leafless_options *options = nullptr);
    returns<leafless_dexel_change> combine_solid(leafless_operation operation, const leafless::solid &solid,
        const leafless_options *options = nullptr);
    [[nodiscard]] returns<leafless::tridexel> freeze(const leafless_options *options = nullptr) const;
};

/// A leafless_layer.
class layer : public detail::owner<leafless_layer, leafless_layer_free> {
public:
    using owner::owner;
    [[nodiscard]] returns<leafless::layer> clipped(span<const std::array<double,4>> planes,
        const double *box_model) const;
    [[nodiscard]] returns<uint64_t> bytes() const;
    [[nodiscard]] returns<leafless::layer> share() const;
    [[nodiscard]] static returns<leafless::layer> from_octree(const leafless::octree &octree,
        const leafless_look *look = nullptr);
    [[nodiscard]] static returns<leafless::layer> from_solid(const leafless::solid &solid,
        const leafless_frame &frame, const leafless_look *look = nullptr);
    [[nodiscard]] static returns<leafless::layer> from_mesh(const leafless::mesh &mesh,
        const leafless_look *look = nullptr);
    [[nodiscard]] static returns<leafless::layer> new_lines(span<const std::array<double,6>> points_model,
        double width, const uint8_t *colour);
    [[nodiscard]] static returns<leafless::layer> new_cells(const leafless_frame &frame,
        span<const leafless_cell> cells, double width, const uint8_t *colour);
    [[nodiscard]] static returns<leafless::layer> from_octree_slice(const leafless::octree &octree,
        const std::array<double,4> &plane, const leafless_slice_look *look = nullptr);
    [[nodiscard]] static returns<leafless::layer> from_solid_slice(const leafless::solid &solid,
        const leafless_frame &frame, const std::array<double,4> &plane,
        const leafless_slice_look *look = nullptr);
    [[nodiscard]] static returns<leafless::layer> new_voxels(const leafless_voxel_arrays &voxels,
        const leafless_transfer &transfer, double unit_model);
};

[[nodiscard]] uint32_t version();
[[nodiscard]] const char *version_string();
[[nodiscard]] uint32_t abi();
[[nodiscard]] const char *status_name(int32_t status);
returns<void> frame_check(const leafless_frame &frame);
[[nodiscard]] returns<leafless_frame> frame_around(const point &min_model, const point &max_model,
    uint32_t depth);
[[nodiscard]] returns<leafless_frame> frame_to_tolerance(const point &min_model, const point &max_model,
    double tolerance_model, double relative);
[[nodiscard]] returns<leafless_frame> frame_aligned(const point &min_model, const point &max_model,
    uint32_t depth);
[[nodiscard]] returns<leafless_frame> frame_with_cells(const point &min_model, const point &max_model,
    double cell_size_model);
[[nodiscard]] returns<leafless_frame> frame_fitted(const point &min_model, const point &max_model,
    uint32_t depth);
[[nodiscard]] returns<double> frame_cell_size(const leafless_frame &frame);
[[nodiscard]] returns<cell_index> frame_cell_at(const leafless_frame &frame, const point &point_model);
[[nodiscard]] returns<leafless_interval> frame_plane(const leafless_frame &frame, uint32_t axis,
    uint32_t index);
[[nodiscard]] returns<std::tuple<point, point>> frame_cell_bounds(const leafless_frame &frame,
    const cell_index &cell, uint32_t level);
[[nodiscard]] returns<leafless_mass_sum> mass_sum_unknown(const leafless_frame &frame, uint32_t level,
    uint64_t code);
[[nodiscard]] returns<leafless_mass_sum> mass_sum_add(const leafless_mass_sum &a, const leafless_mass_sum &b);
[[nodiscard]] returns<leafless_mass_sum> mass_sum_subtract(const leafless_mass_sum &a,
    const leafless_mass_sum &b);
[[nodiscard]] returns<leafless_measures> mass_sum_measures(const leafless_mass_sum &sum);
[[nodiscard]] returns<uint64_t> voxels_find(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, const cell_index &cell, uint32_t level);
[[nodiscard]] returns<std::vector<uint64_t>> voxels_order(const leafless_frame &lattice,
    const uint64_t *codes, const uint8_t *levels, span<const leafless_voxel_kind> kinds, const point &from,
    bool is_eye, const leafless_options *options = nullptr);
returns<void> voxels_moved(const leafless_frame *lattice, const uint64_t *codes, const uint8_t *levels,
    const leafless_voxel_kind *kinds, uint64_t count, const int32_t *axes, const int32_t *offset_cells,
    const leafless_options *options, uint64_t *moved_codes, uint8_t *moved_levels,
    leafless_voxel_kind *moved_kinds, uint64_t *sources, uint64_t capacity, uint64_t *moved_count);
[[nodiscard]] returns<std::tuple<std::vector<uint64_t>,
    std::vector<uint32_t>>> voxels_triangles(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, const leafless::mesh &mesh,
    const leafless_options *options = nullptr);
[[nodiscard]] returns<leafless_file_info> file_describe(const leafless_source &source,
    span<leafless_file_section> sections);
returns<void> file_verify(const leafless_source &source);
[[nodiscard]] returns<leafless_camera> camera_fitted(span<const point> points_model, double azimuth_degrees,
    double elevation_degrees, double field_of_view_degrees, double aspect);
[[nodiscard]] returns<std::array<uint8_t,4>> transfer_colour(const leafless_transfer &transfer,
    const double *value, uint32_t components);
returns<void> voxels_solid_parts(const leafless_frame &lattice, const uint64_t *codes, const uint8_t *levels,
    span<const leafless_voxel_kind> kinds, const leafless::solid &solid, const leafless_options *options,
    span<double> parts);
[[nodiscard]] returns<std::tuple<point, point>> shot_line_of_sight(const leafless_shot &shot, double x,
    double y);
returns<void> picture_render(const leafless_shot &shot, span<const leafless_layer *const> layers,
    const leafless_options *options, span<uint8_t> colours, span<float> depths);
returns<void> picture_write(span<const uint8_t> colours, uint32_t width, uint32_t height,
    const leafless_sink &sink);
[[nodiscard]] returns<leafless_legend_box> picture_draw_bar(span<uint8_t> colours, uint32_t width,
    uint32_t height, std::string_view title, const leafless_transfer &transfer, leafless_legend_side side);
[[nodiscard]] returns<leafless_legend_box> picture_draw_names(span<uint8_t> colours, uint32_t width,
    uint32_t height, std::string_view title, span<const leafless_legend_name> names,
    leafless_legend_side side);

inline returns<leafless::control> control::make() {
    leafless_control *control_handle = nullptr;
    const leafless_status status = leafless_control_new(&control_handle);
    return detail::finish(status, leafless::control(control_handle));
}

inline returns<void> control::cancel() const {
    const leafless_status status = leafless_control_cancel(get());
    return detail::finish(status);
}

inline returns<void> control::reset() const {
    const leafless_status status = leafless_control_reset(get());
    return detail::finish(status);
}

inline returns<std::tuple<bool, double>> control::state() const {
    bool cancelled{};
    double fraction{};
    const leafless_status status = leafless_control_state(get(), &cancelled, &fraction);
    return detail::finish(status, std::tuple<bool, double>(cancelled, fraction));
}

inline returns<leafless::mesh> mesh::share() const {
    leafless_mesh *reference_handle = nullptr;
    const leafless_status status = leafless_mesh_ref(get(), &reference_handle);
    return detail::finish(status, leafless::mesh(reference_handle));
}

inline returns<leafless_mesh_info> mesh::describe() const {
    leafless_mesh_info info = LEAFLESS_INIT(leafless_mesh_info);
    const leafless_status status = leafless_mesh_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<void> mesh::copy(span<point> vertices, span<cell_index> triangles) const {
    const leafless_status status = leafless_mesh_copy(get(), detail::numbers(vertices), vertices.size(),
        detail::numbers(triangles), triangles.size());
    return detail::finish(status);
}

inline returns<std::vector<point>> mesh::normals() const {
    std::uint64_t count = 0;
    std::vector<point> normals;
    leafless_status status = leafless_mesh_normals(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        normals.resize(static_cast<std::size_t>(count));
        status = leafless_mesh_normals(get(), detail::numbers(normals), normals.size(), &count);
    }
    return detail::finish(status, std::move(normals));
}

inline returns<std::tuple<point, point>> mesh::bounds() const {
    point min_model{};
    point max_model{};
    const leafless_status status = leafless_mesh_bounds(get(), min_model.data(), max_model.data());
    return detail::finish(status, std::tuple<point, point>(min_model, max_model));
}

inline returns<double> mesh::volume() const {
    double volume_model{};
    const leafless_status status = leafless_mesh_volume(get(), &volume_model);
    return detail::finish(status, volume_model);
}

inline returns<double> mesh::area() const {
    double area_model{};
    const leafless_status status = leafless_mesh_area(get(), &area_model);
    return detail::finish(status, area_model);
}

inline returns<leafless_mesh_report> mesh::inspect() const {
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    const leafless_status status = leafless_mesh_inspect(get(), &report);
    return detail::finish(status, report);
}

inline returns<std::vector<leafless_mesh_defect>> mesh::defects(uint64_t limit) const {
    std::uint64_t count = 0;
    std::vector<leafless_mesh_defect> defects;
    leafless_status status = leafless_mesh_defects(get(), limit, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        defects.resize(static_cast<std::size_t>(count));
        status = leafless_mesh_defects(get(), limit, defects.data(), defects.size(), &count);
    }
    return detail::finish(status, std::move(defects));
}

inline returns<void> mesh::check_closed(leafless_fill fill) const {
    const leafless_status status = leafless_mesh_check_closed(get(), fill);
    return detail::finish(status);
}

inline returns<leafless::mesh> mesh::sewn() const {
    leafless_mesh *sewn_handle = nullptr;
    const leafless_status status = leafless_mesh_sewn(get(), &sewn_handle);
    return detail::finish(status, leafless::mesh(sewn_handle));
}

inline returns<leafless::mesh> mesh::with_deviation(double deviation_model) const {
    leafless_mesh *stated_handle = nullptr;
    const leafless_status status = leafless_mesh_with_deviation(get(), deviation_model, &stated_handle);
    return detail::finish(status, leafless::mesh(stated_handle));
}

inline returns<leafless::mesh> mesh::transformed(const affine &matrix) const {
    leafless_mesh *moved_handle = nullptr;
    const leafless_status status = leafless_mesh_transformed(get(), matrix.data(), &moved_handle);
    return detail::finish(status, leafless::mesh(moved_handle));
}

inline returns<leafless::mesh> mesh::translated(const point &offset_model) const {
    leafless_mesh *moved_handle = nullptr;
    const leafless_status status = leafless_mesh_translated(get(), offset_model.data(), &moved_handle);
    return detail::finish(status, leafless::mesh(moved_handle));
}

inline returns<leafless::mesh> mesh::make(const leafless_mesh_arrays &arrays) {
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_mesh_new(&arrays, &mesh_handle);
    return detail::finish(status, leafless::mesh(mesh_handle));
}

inline returns<std::tuple<double,
    leafless::mesh>> mesh::from_polyhedron(const leafless_polyhedron_arrays &arrays) {
    double deviation_model{};
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_mesh_from_polyhedron(&arrays, &deviation_model, &mesh_handle);
    return detail::finish(status, std::tuple<double, leafless::mesh>(deviation_model,
        leafless::mesh(mesh_handle)));
}

inline returns<leafless_mesh_moments> mesh::measure(leafless_fill fill,
    const leafless_options *options) const {
    leafless_mesh_moments moments = LEAFLESS_INIT(leafless_mesh_moments);
    const leafless_status status = leafless_mesh_measure(get(), fill, options, &moments);
    return detail::finish(status, moments);
}

inline returns<std::tuple<std::vector<leafless_intersecting_pair>,
    bool>> mesh::intersecting_pairs(const leafless_options *options) const {
    std::uint64_t count = 0;
    std::vector<leafless_intersecting_pair> pairs;
    bool is_complete{};
    leafless_status status = leafless_mesh_intersecting_pairs(get(), options, nullptr, 0, &count,
        &is_complete);
    if (status == LEAFLESS_OK) {
        pairs.resize(static_cast<std::size_t>(count));
        status = leafless_mesh_intersecting_pairs(get(), options, pairs.data(), pairs.size(), &count,
            &is_complete);
    }
    return detail::finish(status, std::tuple<std::vector<leafless_intersecting_pair>, bool>(std::move(pairs),
        is_complete));
}

inline returns<std::tuple<leafless_mesh_file_info, leafless::mesh>> mesh::read(const leafless_source &source,
    const leafless_mesh_options &options) {
    leafless_mesh_file_info found = LEAFLESS_INIT(leafless_mesh_file_info);
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_mesh_read(&source, &options, &found, &mesh_handle);
    return detail::finish(status, std::tuple<leafless_mesh_file_info, leafless::mesh>(found,
        leafless::mesh(mesh_handle)));
}

inline returns<std::tuple<uint64_t, std::string_view>> mesh::peek_warning_at(uint64_t index) const {
    uint64_t count{};
    const char *warning = nullptr;
    std::size_t warning_length = 0;
    const leafless_status status = leafless_mesh_peek_warning_at(get(), index, &count, &warning,
        &warning_length);
    return detail::finish(status, std::tuple<uint64_t, std::string_view>(count, detail::text(warning,
        warning_length)));
}

inline returns<void> mesh::write(const leafless_mesh_write_options &options,
    const leafless_sink &sink) const {
    const leafless_status status = leafless_mesh_write(get(), &options, &sink);
    return detail::finish(status);
}

inline returns<std::tuple<leafless_single_precision,
    leafless::mesh>> mesh::in_single_precision(double tolerance_model,
    const leafless_options *options) const {
    leafless_single_precision report = LEAFLESS_INIT(leafless_single_precision);
    leafless_mesh *single_handle = nullptr;
    const leafless_status status = leafless_mesh_in_single_precision(get(), tolerance_model, options, &report,
        &single_handle);
    return detail::finish(status, std::tuple<leafless_single_precision, leafless::mesh>(report,
        leafless::mesh(single_handle)));
}

inline returns<void> mesh::write_polygons(const leafless_polyhedron_arrays &arrays,
    const leafless_mesh_write_options &options, const leafless_sink &sink) {
    const leafless_status status = leafless_mesh_write_polygons(&arrays, &options, &sink);
    return detail::finish(status);
}

inline returns<leafless::mesh> mesh::written_form(const leafless_mesh_write_options &options) const {
    leafless_mesh *kept_handle = nullptr;
    const leafless_status status = leafless_mesh_written_form(get(), &options, &kept_handle);
    return detail::finish(status, leafless::mesh(kept_handle));
}

inline returns<std::tuple<uint64_t, std::string_view, uint32_t,
    bool>> mesh::peek_attribute_at(uint64_t index) const {
    uint64_t count{};
    const char *name = nullptr;
    std::size_t name_length = 0;
    uint32_t components{};
    bool per_corner{};
    const leafless_status status = leafless_mesh_peek_attribute_at(get(), index, &count, &name, &name_length,
        &components, &per_corner);
    return detail::finish(status, std::tuple<uint64_t, std::string_view, uint32_t, bool>(count,
        detail::text(name, name_length), components, per_corner));
}

inline returns<std::tuple<uint64_t, std::string_view>> mesh::peek_attribute_name_at(uint64_t index,
    uint64_t value) const {
    uint64_t count{};
    const char *name = nullptr;
    std::size_t name_length = 0;
    const leafless_status status = leafless_mesh_peek_attribute_name_at(get(), index, value, &count, &name,
        &name_length);
    return detail::finish(status, std::tuple<uint64_t, std::string_view>(count, detail::text(name,
        name_length)));
}

inline returns<std::vector<double>> mesh::attribute_values(uint64_t index) const {
    std::uint64_t count = 0;
    std::vector<double> values;
    leafless_status status = leafless_mesh_attribute_values(get(), index, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        values.resize(static_cast<std::size_t>(count));
        status = leafless_mesh_attribute_values(get(), index, values.data(), values.size(), &count);
    }
    return detail::finish(status, std::move(values));
}

inline returns<std::vector<uint32_t>> mesh::bodies() const {
    std::uint64_t count = 0;
    std::vector<uint32_t> bodies;
    leafless_status status = leafless_mesh_bodies(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        bodies.resize(static_cast<std::size_t>(count));
        status = leafless_mesh_bodies(get(), bodies.data(), bodies.size(), &count);
    }
    return detail::finish(status, std::move(bodies));
}

inline returns<leafless::mesh> mesh::with_values(const leafless::attribute &attribute, std::string_view name,
    double depth_model, const leafless_options *options) const {
    leafless_mesh *bearing_handle = nullptr;
    const leafless_status status = leafless_mesh_with_values(get(), attribute.get(), name.data(), name.size(),
        depth_model, options, &bearing_handle);
    return detail::finish(status, leafless::mesh(bearing_handle));
}

inline returns<std::tuple<leafless_simplified, leafless::mesh>> mesh::simplify(double tolerance_model,
    const leafless_options *options) const {
    leafless_simplified report = LEAFLESS_INIT(leafless_simplified);
    leafless_mesh *simple_handle = nullptr;
    const leafless_status status = leafless_mesh_simplify(get(), tolerance_model, options, &report,
        &simple_handle);
    return detail::finish(status, std::tuple<leafless_simplified, leafless::mesh>(report,
        leafless::mesh(simple_handle)));
}

inline returns<leafless::solid> solid::from_mesh(const leafless::mesh &mesh, leafless_fill fill) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_from_mesh(mesh.get(), fill, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::from_octree(const leafless::octree &octree) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_from_octree(octree.get(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless_solid_info> solid::describe() const {
    leafless_solid_info info = LEAFLESS_INIT(leafless_solid_info);
    const leafless_status status = leafless_solid_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<leafless::solid> solid::share() const {
    leafless_solid *reference_handle = nullptr;
    const leafless_status status = leafless_solid_ref(get(), &reference_handle);
    return detail::finish(status, leafless::solid(reference_handle));
}

inline returns<leafless::solid> solid::new_ball(const point &centre_model, double radius_model) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_ball(centre_model.data(), radius_model, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_box(const point &min_model, const point &max_model) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_box(min_model.data(), max_model.data(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_halfspace(const point &normal, double offset) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_halfspace(normal.data(), offset, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_quadric(const std::array<double,10> &coefficients) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_quadric(coefficients.data(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_ellipsoid(const point &centre_model, const point &radii_model,
    const affine *matrix) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_ellipsoid(centre_model.data(), radii_model.data(),
        matrix == nullptr ? nullptr : matrix->data(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_cylinder(const point &from_model, const point &to_model,
    double radius_model) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_cylinder(from_model.data(), to_model.data(),
        radius_model, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_frustum(const point &from_model, const point &to_model,
    double from_radius_model, double to_radius_model) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_frustum(from_model.data(), to_model.data(),
        from_radius_model, to_radius_model, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_power(const point &coefficients, const point &centre_model,
    const cell_index &exponents, double constant) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_power(coefficients.data(), centre_model.data(),
        exponents.data(), constant, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_torus(const point &centre_model, const point &axis,
    double major_model, double minor_model) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_torus(centre_model.data(), axis.data(), major_model,
        minor_model, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_wedge(const point &size_model, double top_model,
    const affine *matrix) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_wedge(size_model.data(), top_model,
        matrix == nullptr ? nullptr : matrix->data(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_prism(span<const std::array<double,2>> polygon_model,
    double low_model, double high_model, const affine *matrix) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_prism(detail::numbers(polygon_model),
        polygon_model.size(), low_model, high_model, matrix == nullptr ? nullptr : matrix->data(),
        &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_convex(span<const std::array<double,4>> planes) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_convex(detail::numbers(planes), planes.size(),
        &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::combine(leafless_operation operation,
    span<const leafless_solid *const> solids) {
    leafless_solid *result_handle = nullptr;
    const leafless_status status = leafless_solid_combine(operation, solids.data(), solids.size(),
        &result_handle);
    return detail::finish(status, leafless::solid(result_handle));
}

inline returns<leafless::solid> solid::complement() const {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_complement(get(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<std::tuple<leafless_motion, leafless::solid>> solid::placed(const affine &matrix) const {
    leafless_motion motion{};
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_placed(get(), matrix.data(), &motion, &solid_handle);
    return detail::finish(status, std::tuple<leafless_motion, leafless::solid>(motion,
        leafless::solid(solid_handle)));
}

inline returns<leafless::solid> solid::adaptive(double tolerance_model) const {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_adaptive(get(), tolerance_model, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::with_touch(leafless_touch touch) const {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_with_touch(get(), touch, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_callbacks(const leafless_solid_callbacks &callbacks) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_callbacks(&callbacks, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::new_function(const leafless_solid_function &function) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_new_function(&function, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::from_volume(const leafless::volume &volume,
    const leafless_interval *band, const leafless_options *options) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_from_volume(volume.get(), band, options, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::from_scene(const leafless::scene &scene, const leafless_frame &frame) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_from_scene(scene.get(), &frame, &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::from_shards(const leafless::octree &top, uint32_t level,
    span<const uint64_t> codes, span<const leafless_octree *const> octrees) {
    detail::same_size(codes.size(), octrees.size());
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_from_shards(top.get(), level, codes.data(), octrees.data(),
        codes.size(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<void> solid::contains_many(const leafless_frame &frame, span<const point> points_model,
    const leafless_options *options, span<leafless_membership> memberships) const {
    detail::same_size(points_model.size(), memberships.size());
    const leafless_status status = leafless_solid_contains_many(get(), &frame, detail::numbers(points_model),
        points_model.size(), options, memberships.data());
    return detail::finish(status);
}

inline returns<leafless_region> solid::classify_box(const leafless_frame &frame, const point &min_model,
    const point &max_model, const leafless_options *options) const {
    leafless_region region{};
    const leafless_status status = leafless_solid_classify_box(get(), &frame, min_model.data(),
        max_model.data(), options, &region);
    return detail::finish(status, region);
}

inline returns<void> solid::cast_rays(const leafless_frame &frame, span<const leafless_ray> rays,
    leafless_obstacle on, const leafless_options *options, span<leafless_ray_hit> hits) const {
    detail::same_size(rays.size(), hits.size());
    const leafless_status status = leafless_solid_cast_rays(get(), &frame, rays.data(), rays.size(), on,
        options, hits.data());
    return detail::finish(status);
}

inline returns<std::tuple<std::vector<leafless_interval>,
    std::vector<leafless_interval>>> solid::ray_spans(const leafless_frame &frame, const leafless_ray &ray,
    const leafless_options *options) const {
    std::uint64_t inner_count = 0;
    std::vector<leafless_interval> inner;
    std::uint64_t outer_count = 0;
    std::vector<leafless_interval> outer;
    leafless_status status = leafless_solid_ray_spans(get(), &frame, &ray, options, nullptr, 0, &inner_count,
        nullptr, 0, &outer_count);
    if (status == LEAFLESS_OK) {
        inner.resize(static_cast<std::size_t>(inner_count));
        outer.resize(static_cast<std::size_t>(outer_count));
        status = leafless_solid_ray_spans(get(), &frame, &ray, options, inner.data(), inner.size(),
            &inner_count, outer.data(), outer.size(), &outer_count);
    }
    return detail::finish(status, std::tuple<std::vector<leafless_interval>,
        std::vector<leafless_interval>>(std::move(inner), std::move(outer)));
}

inline returns<leafless_sight> solid::line_of_sight(const leafless_frame &frame, const point &from_model,
    const point &to_model, const leafless_options *options) const {
    leafless_sight sight{};
    const leafless_status status = leafless_solid_line_of_sight(get(), &frame, from_model.data(),
        to_model.data(), options, &sight);
    return detail::finish(status, sight);
}

inline returns<leafless::columns> solid::columns(const leafless_frame &frame, uint32_t axis,
    const ray_index *first, const ray_index *end, const leafless_options *options) const {
    leafless_columns *columns_handle = nullptr;
    const leafless_status status = leafless_solid_columns(get(), &frame, axis,
        first == nullptr ? nullptr : first->data(), end == nullptr ? nullptr : end->data(), options,
        &columns_handle);
    return detail::finish(status, leafless::columns(columns_handle));
}

inline returns<std::vector<leafless_interval>> solid::heights(const leafless_frame &frame, uint32_t axis,
    const ray_index *first, const ray_index *end, leafless_side side, const leafless_options *options) const {
    std::uint64_t count = 0;
    std::vector<leafless_interval> heights_model;
    leafless_status status = leafless_solid_heights(get(), &frame, axis,
        first == nullptr ? nullptr : first->data(), end == nullptr ? nullptr : end->data(), side, options,
        nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        heights_model.resize(static_cast<std::size_t>(count));
        status = leafless_solid_heights(get(), &frame, axis, first == nullptr ? nullptr : first->data(),
            end == nullptr ? nullptr : end->data(), side, options, heights_model.data(), heights_model.size(),
            &count);
    }
    return detail::finish(status, std::move(heights_model));
}

inline returns<leafless_region> solid::classify_in(const leafless::solid &region, const leafless_frame &frame,
    const leafless_options *options) const {
    leafless_region relation{};
    const leafless_status status = leafless_solid_classify_in(get(), region.get(), &frame, options,
        &relation);
    return detail::finish(status, relation);
}

inline returns<leafless_cells_in> solid::cells_in(const leafless::solid &region, const leafless_frame &frame,
    const leafless_options *options) const {
    leafless_cells_in cells{};
    const leafless_status status = leafless_solid_cells_in(get(), region.get(), &frame, options, &cells);
    return detail::finish(status, cells);
}

inline returns<leafless_interval> solid::volume_in(const leafless::solid &region, const leafless_frame &frame,
    const leafless_options *options) const {
    leafless_interval volume_model{};
    const leafless_status status = leafless_solid_volume_in(get(), region.get(), &frame, options,
        &volume_model);
    return detail::finish(status, volume_model);
}

inline returns<leafless_measures> solid::measure(const leafless_frame &frame, double relative,
    double absolute_model, const leafless_options *options) const {
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    const leafless_status status = leafless_solid_measure(get(), &frame, relative, absolute_model, options,
        &measures);
    return detail::finish(status, measures);
}

inline returns<leafless_surface_area> solid::surface_area(const leafless_frame &frame, double relative,
    double absolute_model, const leafless_options *options) const {
    leafless_surface_area surface = LEAFLESS_INIT(leafless_surface_area);
    const leafless_status status = leafless_solid_surface_area(get(), &frame, relative, absolute_model,
        options, &surface);
    return detail::finish(status, surface);
}

inline returns<leafless_section_area> solid::section_area(const leafless_frame &frame,
    const point &point_model, const point &normal, double relative, double absolute_model,
    const leafless_options *options) const {
    leafless_section_area section = LEAFLESS_INIT(leafless_section_area);
    const leafless_status status = leafless_solid_section_area(get(), &frame, point_model.data(),
        normal.data(), relative, absolute_model, options, &section);
    return detail::finish(status, section);
}

inline returns<leafless_extent> solid::bounding_box(const leafless_frame &frame, double tolerance_model,
    const leafless_options *options) const {
    leafless_extent extent = LEAFLESS_INIT(leafless_extent);
    const leafless_status status = leafless_solid_bounding_box(get(), &frame, tolerance_model, options,
        &extent);
    return detail::finish(status, extent);
}

inline returns<leafless_mass_sum> solid::measure_cell(const leafless_frame &frame, uint32_t level,
    uint64_t code, double relative, double absolute_model, const leafless_options *options) const {
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum);
    const leafless_status status = leafless_solid_measure_cell(get(), &frame, level, code, relative,
        absolute_model, options, &sum);
    return detail::finish(status, sum);
}

inline returns<void> solid::distances(const leafless_frame &frame, span<const point> points_model,
    leafless_distance_to to, double tolerance_model, const leafless_options *options,
    span<leafless_point_distance> distances) const {
    detail::same_size(points_model.size(), distances.size());
    const leafless_status status = leafless_solid_distances(get(), &frame, detail::numbers(points_model),
        points_model.size(), to, tolerance_model, options, distances.data());
    return detail::finish(status);
}

inline returns<leafless::solid> solid::transformed(const leafless_frame &own, const affine &matrix) const {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_transformed(get(), &own, matrix.data(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::solid> solid::resampled(const leafless_frame &own, const affine &matrix) const {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_resampled(get(), &own, matrix.data(), &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless_interference> solid::interfere(const leafless::solid &b, const leafless_frame &frame,
    double tolerance_model, const leafless_options *options) const {
    leafless_interference interference{};
    const leafless_status status = leafless_solid_interfere(get(), b.get(), &frame, tolerance_model, options,
        &interference);
    return detail::finish(status, interference);
}

inline returns<void> solid::interfere_many(const leafless::solid &b, const leafless_frame &own,
    span<const affine> matrices, const leafless_frame &frame, double tolerance_model,
    const leafless_options *options, span<leafless_interference> interferences) const {
    detail::same_size(matrices.size(), interferences.size());
    const leafless_status status = leafless_solid_interfere_many(get(), b.get(), &own,
        detail::numbers(matrices), matrices.size(), &frame, tolerance_model, options, interferences.data());
    return detail::finish(status);
}

inline returns<leafless_clearance> solid::clearance(const leafless::solid &b, const leafless_frame &frame,
    double tolerance_model, const leafless_options *options) const {
    leafless_clearance clearance = LEAFLESS_INIT(leafless_clearance);
    const leafless_status status = leafless_solid_clearance(get(), b.get(), &frame, tolerance_model, options,
        &clearance);
    return detail::finish(status, clearance);
}

inline returns<leafless_gap> solid::gap_at_least(const leafless::solid &b, const leafless_frame &frame,
    double least_model, const leafless_options *options) const {
    leafless_gap gap = LEAFLESS_INIT(leafless_gap);
    const leafless_status status = leafless_solid_gap_at_least(get(), b.get(), &frame, least_model, options,
        &gap);
    return detail::finish(status, gap);
}

inline returns<void> solid::clearance_many(const leafless::solid &b, const leafless_frame &own,
    span<const affine> matrices, const leafless_frame &frame, double tolerance_model,
    const leafless_options *options, span<leafless_placed_clearance> clearances) const {
    detail::same_size(matrices.size(), clearances.size());
    const leafless_status status = leafless_solid_clearance_many(get(), b.get(), &own,
        detail::numbers(matrices), matrices.size(), &frame, tolerance_model, options, clearances.data());
    return detail::finish(status);
}

inline returns<void> solid::gap_at_least_many(const leafless::solid &b, const leafless_frame &own,
    span<const affine> matrices, const leafless_frame &frame, double least_model,
    const leafless_options *options, span<leafless_placed_gap> gaps) const {
    detail::same_size(matrices.size(), gaps.size());
    const leafless_status status = leafless_solid_gap_at_least_many(get(), b.get(), &own,
        detail::numbers(matrices), matrices.size(), &frame, least_model, options, gaps.data());
    return detail::finish(status);
}

inline returns<leafless_deviation> solid::deviation(const leafless::solid &b, const leafless_frame &frame,
    double tolerance_model, double within_model, const leafless_options *options) const {
    leafless_deviation deviation = LEAFLESS_INIT(leafless_deviation);
    const leafless_status status = leafless_solid_deviation(get(), b.get(), &frame, tolerance_model,
        within_model, options, &deviation);
    return detail::finish(status, deviation);
}

inline returns<std::vector<leafless_material>> solid::materials(const leafless::channel &channel,
    const leafless_frame &frame, double relative, double absolute_model,
    const leafless_options *options) const {
    std::uint64_t count = 0;
    std::vector<leafless_material> measured;
    leafless_status status = leafless_solid_materials(get(), channel.get(), &frame, relative, absolute_model,
        options, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        measured.resize(static_cast<std::size_t>(count));
        status = leafless_solid_materials(get(), channel.get(), &frame, relative, absolute_model, options,
            measured.data(), measured.size(), &count);
    }
    return detail::finish(status, std::move(measured));
}

inline returns<leafless::mesh> solid::surface(const leafless_frame &frame,
    const leafless_surface_options *surface, const leafless_options *options) const {
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_solid_surface(get(), &frame, surface, options, &mesh_handle);
    return detail::finish(status, leafless::mesh(mesh_handle));
}

inline returns<leafless::boundary> solid::boundary(const leafless_frame &frame, double tolerance_model,
    const leafless_options *options) const {
    leafless_boundary *boundary_handle = nullptr;
    const leafless_status status = leafless_solid_boundary(get(), &frame, tolerance_model, options,
        &boundary_handle);
    return detail::finish(status, leafless::boundary(boundary_handle));
}

inline returns<std::tuple<leafless_contour_report,
    leafless::mesh>> solid::contour(const leafless_frame &frame, double tolerance_model,
    const leafless_options *options) const {
    leafless_contour_report report = LEAFLESS_INIT(leafless_contour_report);
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_solid_contour(get(), &frame, tolerance_model, options, &report,
        &mesh_handle);
    return detail::finish(status, std::tuple<leafless_contour_report, leafless::mesh>(report,
        leafless::mesh(mesh_handle)));
}

inline returns<leafless::solid> solid::from_tridexel(const leafless::tridexel &tridexel, bool is_truth,
    const leafless_options *options) {
    leafless_solid *solid_handle = nullptr;
    const leafless_status status = leafless_solid_from_tridexel(tridexel.get(), is_truth, options,
        &solid_handle);
    return detail::finish(status, leafless::solid(solid_handle));
}

inline returns<leafless::volume> volume::share() const {
    leafless_volume *reference_handle = nullptr;
    const leafless_status status = leafless_volume_ref(get(), &reference_handle);
    return detail::finish(status, leafless::volume(reference_handle));
}

inline returns<leafless_volume_info> volume::describe() const {
    leafless_volume_info info = LEAFLESS_INIT(leafless_volume_info);
    const leafless_status status = leafless_volume_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<uint64_t> volume::peek_samples(const void **samples) const {
    uint64_t length{};
    const leafless_status status = leafless_volume_peek_samples(get(), samples, &length);
    return detail::finish(status, length);
}

inline returns<leafless_frame> volume::frame() const {
    leafless_frame frame{};
    const leafless_status status = leafless_volume_frame(get(), &frame);
    return detail::finish(status, frame);
}

inline returns<std::tuple<point, point>> volume::bounds() const {
    point min_model{};
    point max_model{};
    const leafless_status status = leafless_volume_bounds(get(), min_model.data(), max_model.data());
    return detail::finish(status, std::tuple<point, point>(min_model, max_model));
}

inline returns<leafless_interval> volume::range(const leafless_options *options) const {
    leafless_interval range{};
    const leafless_status status = leafless_volume_range(get(), options, &range);
    return detail::finish(status, range);
}

inline returns<leafless::volume> volume::make(const leafless_volume_layout &layout,
    const leafless_source &source) {
    leafless_volume *volume_handle = nullptr;
    const leafless_status status = leafless_volume_new(&layout, &source, &volume_handle);
    return detail::finish(status, leafless::volume(volume_handle));
}

inline returns<leafless::volume> volume::read(const leafless_source &source, const leafless_source &data) {
    leafless_volume *volume_handle = nullptr;
    const leafless_status status = leafless_volume_read(&source, &data, &volume_handle);
    return detail::finish(status, leafless::volume(volume_handle));
}

inline returns<std::vector<char>> volume::data_file(span<const uint8_t> bytes) {
    std::uint64_t name_length = 0;
    std::vector<char> name;
    leafless_status status = leafless_volume_data_file(bytes.data(), bytes.size(), nullptr, 0, &name_length);
    if (status == LEAFLESS_OK) {
        name.resize(static_cast<std::size_t>(name_length));
        status = leafless_volume_data_file(bytes.data(), bytes.size(), name.data(), name.size(),
            &name_length);
    }
    return detail::finish(status, std::move(name));
}

inline returns<void> volume::write(leafless_volume_format format, const leafless_sink &sink) const {
    const leafless_status status = leafless_volume_write(get(), format, &sink);
    return detail::finish(status);
}

inline returns<leafless::mesh> volume::surface(const leafless_interval *band,
    const leafless_options *options) const {
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_volume_surface(get(), band, options, &mesh_handle);
    return detail::finish(status, leafless::mesh(mesh_handle));
}

inline returns<leafless::scene> scene::read(const leafless_source &source,
    const leafless_scene_options &options) {
    leafless_scene *scene_handle = nullptr;
    const leafless_status status = leafless_scene_read(&source, &options, &scene_handle);
    return detail::finish(status, leafless::scene(scene_handle));
}

inline returns<leafless_scene_info> scene::describe() const {
    leafless_scene_info report = LEAFLESS_INIT(leafless_scene_info);
    const leafless_status status = leafless_scene_describe(get(), &report);
    return detail::finish(status, report);
}

inline returns<std::tuple<leafless_scene_mesh_info,
    leafless_mesh_report>> scene::describe_mesh_at(uint64_t index) const {
    leafless_scene_mesh_info mesh = LEAFLESS_INIT(leafless_scene_mesh_info);
    leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
    const leafless_status status = leafless_scene_describe_mesh_at(get(), index, &mesh, &report);
    return detail::finish(status, std::tuple<leafless_scene_mesh_info, leafless_mesh_report>(mesh, report));
}

inline returns<std::vector<uint8_t>> scene::mesh_file_at(uint64_t index) const {
    std::uint64_t length = 0;
    std::vector<uint8_t> bytes;
    leafless_status status = leafless_scene_mesh_file_at(get(), index, nullptr, 0, &length);
    if (status == LEAFLESS_OK) {
        bytes.resize(static_cast<std::size_t>(length));
        status = leafless_scene_mesh_file_at(get(), index, bytes.data(), bytes.size(), &length);
    }
    return detail::finish(status, std::move(bytes));
}

inline returns<leafless::scene> scene::share() const {
    leafless_scene *reference_handle = nullptr;
    const leafless_status status = leafless_scene_ref(get(), &reference_handle);
    return detail::finish(status, leafless::scene(reference_handle));
}

inline returns<std::tuple<point, point>> scene::bounds() const {
    point min_model{};
    point max_model{};
    const leafless_status status = leafless_scene_bounds(get(), min_model.data(), max_model.data());
    return detail::finish(status, std::tuple<point, point>(min_model, max_model));
}

inline returns<leafless::octree> octree::new_uniform(const leafless_frame &frame, leafless_tag tag,
    leafless_tag exterior) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_new_uniform(&frame, tag, exterior, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::share() const {
    leafless_octree *reference_handle = nullptr;
    const leafless_status status = leafless_octree_ref(get(), &reference_handle);
    return detail::finish(status, leafless::octree(reference_handle));
}

inline returns<leafless_octree_info> octree::describe() const {
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    const leafless_status status = leafless_octree_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<leafless::octree> octree::with_proof(leafless_proven proven, double displacement_model) const {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_with_proof(get(), proven, displacement_model,
        &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<leafless_statistics> octree::statistics() const {
    leafless_statistics statistics{};
    const leafless_status status = leafless_octree_statistics(get(), &statistics);
    return detail::finish(status, statistics);
}

inline returns<std::vector<leafless_statistics>> octree::levels() const {
    std::uint64_t count = 0;
    std::vector<leafless_statistics> levels;
    leafless_status status = leafless_octree_levels(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        levels.resize(static_cast<std::size_t>(count));
        status = leafless_octree_levels(get(), levels.data(), levels.size(), &count);
    }
    return detail::finish(status, std::move(levels));
}

inline returns<void> octree::check() const {
    const leafless_status status = leafless_octree_check(get());
    return detail::finish(status);
}

inline returns<bool> octree::equal(const leafless::octree &b) const {
    bool equal{};
    const leafless_status status = leafless_octree_equal(get(), b.get(), &equal);
    return detail::finish(status, equal);
}

inline returns<leafless::octree> octree::with_metadata(std::string_view key, std::string_view value) const {
    leafless_octree *named_handle = nullptr;
    const leafless_status status = leafless_octree_with_metadata(get(), key.data(), key.size(), value.data(),
        value.size(), &named_handle);
    return detail::finish(status, leafless::octree(named_handle));
}

inline returns<leafless::octree> octree::without_metadata(std::string_view key) const {
    leafless_octree *unnamed_handle = nullptr;
    const leafless_status status = leafless_octree_without_metadata(get(), key.data(), key.size(),
        &unnamed_handle);
    return detail::finish(status, leafless::octree(unnamed_handle));
}

inline returns<std::string_view> octree::peek_metadata(std::string_view key) const {
    const char *value = nullptr;
    std::size_t value_length = 0;
    const leafless_status status = leafless_octree_peek_metadata(get(), key.data(), key.size(), &value,
        &value_length);
    return detail::finish(status, detail::text(value, value_length));
}

inline returns<std::tuple<uint64_t, std::string_view,
    std::string_view>> octree::peek_metadata_at(uint64_t index) const {
    uint64_t count{};
    const char *key = nullptr;
    std::size_t key_length = 0;
    const char *value = nullptr;
    std::size_t value_length = 0;
    const leafless_status status = leafless_octree_peek_metadata_at(get(), index, &count, &key, &key_length,
        &value, &value_length);
    return detail::finish(status, std::tuple<uint64_t, std::string_view, std::string_view>(count,
        detail::text(key, key_length), detail::text(value, value_length)));
}

inline returns<leafless::octree> octree::build(const leafless::solid &solid, const leafless_frame &frame,
    leafless_rule rule, const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_build(solid.get(), &frame, rule, options, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::resolve(leafless_rule rule, const leafless_options *options) const {
    leafless_octree *resolved_handle = nullptr;
    const leafless_status status = leafless_octree_resolve(get(), rule, options, &resolved_handle);
    return detail::finish(status, leafless::octree(resolved_handle));
}

inline returns<leafless::octree> octree::compact() const {
    leafless_octree *compacted_handle = nullptr;
    const leafless_status status = leafless_octree_compact(get(), &compacted_handle);
    return detail::finish(status, leafless::octree(compacted_handle));
}

inline returns<leafless::octree> octree::combine(leafless_operation operation,
    span<const leafless_octree *const> octrees, const leafless_options *options) {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_combine(operation, octrees.data(), octrees.size(), options,
        &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<leafless::octree> octree::complement(const leafless_options *options) const {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_complement(get(), options, &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<leafless::octree> octree::build_extended(const leafless::solid &solid,
    const leafless_frame &frame, const leafless_cut_options *cuts, const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_build_extended(solid.get(), &frame, cuts, options,
        &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::plain(uint32_t depth, leafless_rule rule,
    const leafless_options *options) const {
    leafless_octree *plain_handle = nullptr;
    const leafless_status status = leafless_octree_plain(get(), depth, rule, options, &plain_handle);
    return detail::finish(status, leafless::octree(plain_handle));
}

inline returns<leafless_cut_counts> octree::count_cuts() const {
    leafless_cut_counts counts = LEAFLESS_INIT(leafless_cut_counts);
    const leafless_status status = leafless_octree_count_cuts(get(), &counts);
    return detail::finish(status, counts);
}

inline returns<leafless_stored_surface_info> octree::surface_at(uint32_t surface, span<double> terms,
    span<double> placements) const {
    leafless_stored_surface_info info = LEAFLESS_INIT(leafless_stored_surface_info);
    const leafless_status status = leafless_octree_surface_at(get(), surface, &info, terms.data(),
        terms.size(), placements.data(), placements.size());
    return detail::finish(status, info);
}

inline returns<leafless_cell_function> octree::cell_function(uint32_t level, const cell_index &cell) const {
    leafless_cell_function function{};
    const leafless_status status = leafless_octree_cell_function(get(), level, cell.data(), &function);
    return detail::finish(status, function);
}

inline returns<leafless::octree> octree::build_shard(const leafless::solid &solid,
    const leafless_frame &frame, leafless_rule rule, const leafless_shard &shard,
    const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_build_shard(solid.get(), &frame, rule, &shard, options,
        &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::build_extended_shard(const leafless::solid &solid,
    const leafless_frame &frame, const leafless_cut_options *cuts, const leafless_shard &shard,
    const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_build_extended_shard(solid.get(), &frame, cuts, &shard,
        options, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::shard(const leafless_shard &shard,
    const leafless_options *options) const {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_shard(get(), &shard, options, &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<leafless::octree> octree::join(span<const leafless_octree *const> octrees,
    const leafless_options *options) {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_join(octrees.data(), octrees.size(), options,
        &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<std::vector<uint64_t>> octree::open_cells(uint32_t level) const {
    std::uint64_t count = 0;
    std::vector<uint64_t> codes;
    leafless_status status = leafless_octree_open_cells(get(), level, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        codes.resize(static_cast<std::size_t>(count));
        status = leafless_octree_open_cells(get(), level, codes.data(), codes.size(), &count);
    }
    return detail::finish(status, std::move(codes));
}

inline returns<std::vector<leafless_statistics>> octree::statistics_with(uint32_t level,
    span<const uint64_t> codes, span<const leafless_statistics> levels) const {
    std::uint64_t count = 0;
    std::vector<leafless_statistics> joined;
    leafless_status status = leafless_octree_statistics_with(get(), level, codes.data(), codes.size(),
        levels.data(), levels.size(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        joined.resize(static_cast<std::size_t>(count));
        status = leafless_octree_statistics_with(get(), level, codes.data(), codes.size(), levels.data(),
            levels.size(), joined.data(), joined.size(), &count);
    }
    return detail::finish(status, std::move(joined));
}

inline returns<leafless_membership> octree::contains(const point &point_model) const {
    leafless_membership membership{};
    const leafless_status status = leafless_octree_contains(get(), point_model.data(), &membership);
    return detail::finish(status, membership);
}

inline returns<void> octree::contains_many(span<const point> points_model,
    span<leafless_membership> memberships) const {
    detail::same_size(points_model.size(), memberships.size());
    const leafless_status status = leafless_octree_contains_many(get(), detail::numbers(points_model),
        points_model.size(), memberships.data());
    return detail::finish(status);
}

inline returns<leafless_tag> octree::tag_at(const cell_index &cell) const {
    leafless_tag tag{};
    const leafless_status status = leafless_octree_tag_at(get(), cell.data(), &tag);
    return detail::finish(status, tag);
}

inline returns<leafless_region> octree::classify_box(const point &min_model, const point &max_model) const {
    leafless_region region{};
    const leafless_status status = leafless_octree_classify_box(get(), min_model.data(), max_model.data(),
        &region);
    return detail::finish(status, region);
}

inline returns<std::tuple<std::vector<uint64_t>, std::vector<uint64_t>>> octree::bitmap(uint32_t level,
    const cell_index &min_cell, const cell_index &max_cell, const leafless_options *options) const {
    std::uint64_t count = 0;
    std::vector<uint64_t> inner;
    std::vector<uint64_t> outer;
    leafless_status status = leafless_octree_bitmap(get(), level, min_cell.data(), max_cell.data(), options,
        nullptr, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        inner.resize(static_cast<std::size_t>(count));
        outer.resize(static_cast<std::size_t>(count));
        status = leafless_octree_bitmap(get(), level, min_cell.data(), max_cell.data(), options, inner.data(),
            outer.data(), inner.size(), &count);
    }
    return detail::finish(status, std::tuple<std::vector<uint64_t>, std::vector<uint64_t>>(std::move(inner),
        std::move(outer)));
}

inline returns<void> octree::cast_rays(span<const leafless_ray> rays, leafless_obstacle on,
    span<leafless_ray_hit> hits) const {
    detail::same_size(rays.size(), hits.size());
    const leafless_status status = leafless_octree_cast_rays(get(), rays.data(), rays.size(), on,
        hits.data());
    return detail::finish(status);
}

inline returns<std::tuple<std::vector<leafless_interval>,
    std::vector<leafless_interval>>> octree::ray_spans(const leafless_ray &ray) const {
    std::uint64_t inner_count = 0;
    std::vector<leafless_interval> inner;
    std::uint64_t outer_count = 0;
    std::vector<leafless_interval> outer;
    leafless_status status = leafless_octree_ray_spans(get(), &ray, nullptr, 0, &inner_count, nullptr, 0,
        &outer_count);
    if (status == LEAFLESS_OK) {
        inner.resize(static_cast<std::size_t>(inner_count));
        outer.resize(static_cast<std::size_t>(outer_count));
        status = leafless_octree_ray_spans(get(), &ray, inner.data(), inner.size(), &inner_count,
            outer.data(), outer.size(), &outer_count);
    }
    return detail::finish(status, std::tuple<std::vector<leafless_interval>,
        std::vector<leafless_interval>>(std::move(inner), std::move(outer)));
}

inline returns<leafless::columns> octree::columns(uint32_t axis, const ray_index *first,
    const ray_index *end) const {
    leafless_columns *columns_handle = nullptr;
    const leafless_status status = leafless_octree_columns(get(), axis,
        first == nullptr ? nullptr : first->data(), end == nullptr ? nullptr : end->data(), &columns_handle);
    return detail::finish(status, leafless::columns(columns_handle));
}

inline returns<std::vector<leafless_interval>> octree::heights(uint32_t axis, const ray_index *first,
    const ray_index *end, leafless_side side) const {
    std::uint64_t count = 0;
    std::vector<leafless_interval> heights_model;
    leafless_status status = leafless_octree_heights(get(), axis, first == nullptr ? nullptr : first->data(),
        end == nullptr ? nullptr : end->data(), side, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        heights_model.resize(static_cast<std::size_t>(count));
        status = leafless_octree_heights(get(), axis, first == nullptr ? nullptr : first->data(),
            end == nullptr ? nullptr : end->data(), side, heights_model.data(), heights_model.size(), &count);
    }
    return detail::finish(status, std::move(heights_model));
}

inline returns<std::tuple<uint64_t, uint64_t>> octree::cells_in_box(const cell_index &min_cell,
    const cell_index &max_cell) const {
    uint64_t least{};
    uint64_t most{};
    const leafless_status status = leafless_octree_cells_in_box(get(), min_cell.data(), max_cell.data(),
        &least, &most);
    return detail::finish(status, std::tuple<uint64_t, uint64_t>(least, most));
}

inline returns<leafless_interval> octree::volume_in_box(const point &min_model,
    const point &max_model) const {
    leafless_interval volume_model{};
    const leafless_status status = leafless_octree_volume_in_box(get(), min_model.data(), max_model.data(),
        &volume_model);
    return detail::finish(status, volume_model);
}

inline returns<leafless_cells_in> octree::cells_in(const leafless::solid &region,
    const leafless_options *options) const {
    leafless_cells_in cells{};
    const leafless_status status = leafless_octree_cells_in(get(), region.get(), options, &cells);
    return detail::finish(status, cells);
}

inline returns<leafless_interval> octree::volume_in(const leafless::solid &region,
    const leafless_options *options) const {
    leafless_interval volume_model{};
    const leafless_status status = leafless_octree_volume_in(get(), region.get(), options, &volume_model);
    return detail::finish(status, volume_model);
}

inline returns<void> octree::distances(span<const point> points_model, leafless_distance_to to,
    const leafless_options *options, span<leafless_interval> distances_model) const {
    detail::same_size(points_model.size(), distances_model.size());
    const leafless_status status = leafless_octree_distances(get(), detail::numbers(points_model),
        points_model.size(), to, options, distances_model.data());
    return detail::finish(status);
}

inline returns<std::vector<leafless_near_cell>> octree::nearest_cells(const point &point_model,
    uint32_t tags) const {
    std::uint64_t count = 0;
    std::vector<leafless_near_cell> cells;
    leafless_status status = leafless_octree_nearest_cells(get(), point_model.data(), tags, nullptr, 0,
        &count);
    if (status == LEAFLESS_OK) {
        cells.resize(static_cast<std::size_t>(count));
        status = leafless_octree_nearest_cells(get(), point_model.data(), tags, cells.data(), cells.size(),
            &count);
    }
    return detail::finish(status, std::move(cells));
}

inline returns<void> octree::distance_field(const cell_index &min_cell, const cell_index &max_cell,
    const leafless_options *options, span<float> field) const {
    const leafless_status status = leafless_octree_distance_field(get(), min_cell.data(), max_cell.data(),
        options, field.data(), field.size());
    return detail::finish(status);
}

inline returns<leafless::octree> octree::with_channel(const leafless::channel &channel) const {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_with_channel(get(), channel.get(), &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<leafless::octree> octree::without_channel(std::string_view name) const {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_without_channel(get(), name.data(), name.size(),
        &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<leafless::channel> octree::channel_at(uint64_t index) const {
    leafless_channel *channel_handle = nullptr;
    const leafless_status status = leafless_octree_channel_at(get(), index, &channel_handle);
    return detail::finish(status, leafless::channel(channel_handle));
}

inline returns<leafless::channel> octree::channel(std::string_view name) const {
    leafless_channel *channel_handle = nullptr;
    const leafless_status status = leafless_octree_channel(get(), name.data(), name.size(), &channel_handle);
    return detail::finish(status, leafless::channel(channel_handle));
}

inline returns<leafless::octree> octree::carry_channels(span<const leafless_octree *const> operands,
    leafless_carry carry, span<const leafless_carry_rule> rules, const leafless_options *options) const {
    leafless_octree *result_handle = nullptr;
    const leafless_status status = leafless_octree_carry_channels(get(), operands.data(), operands.size(),
        carry, rules.data(), rules.size(), options, &result_handle);
    return detail::finish(status, leafless::octree(result_handle));
}

inline returns<void> octree::voxels(const leafless_voxel_options *voxel_options,
    const leafless_options *options, leafless_frame *lattice, uint64_t *codes, uint8_t *levels,
    leafless_voxel_kind *kinds, double *corners_model, double *values, uint64_t capacity,
    uint64_t *count) const {
    const leafless_status status = leafless_octree_voxels(get(), voxel_options, options, lattice, codes,
        levels, kinds, corners_model, values, capacity, count);
    return detail::finish(status);
}

inline returns<leafless::octree> octree::from_voxels(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, leafless_tag boundary,
    const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_from_voxels(&lattice, codes, levels, kinds.data(),
        kinds.size(), boundary, options, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::mesh> octree::surface(const leafless_surface_options *surface,
    const leafless_options *options) const {
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_octree_surface(get(), surface, options, &mesh_handle);
    return detail::finish(status, leafless::mesh(mesh_handle));
}

inline returns<leafless::octree> octree::from_tridexel(const leafless::tridexel &tridexel,
    const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_from_tridexel(tridexel.get(), options, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::from_tridexel_ends(const leafless::tridexel &tridexel,
    const leafless_options *options) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_from_tridexel_ends(tridexel.get(), options,
        &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::octree> octree::read(const leafless_source &source) {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_octree_read(&source, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<void> octree::write(const leafless_sink &sink) const {
    const leafless_status status = leafless_octree_write(get(), &sink);
    return detail::finish(status);
}

inline returns<leafless::point_cursor> point_cursor::make(const leafless::octree &octree) {
    leafless_point_cursor *cursor_handle = nullptr;
    const leafless_status status = leafless_point_cursor_new(octree.get(), &cursor_handle);
    return detail::finish(status, leafless::point_cursor(cursor_handle));
}

inline returns<leafless_membership> point_cursor::contains(const point &point_model) {
    leafless_membership membership{};
    const leafless_status status = leafless_point_cursor_contains(get(), point_model.data(), &membership);
    return detail::finish(status, membership);
}

inline returns<leafless_tag> point_cursor::tag_at(const cell_index &cell) {
    leafless_tag tag{};
    const leafless_status status = leafless_point_cursor_tag_at(get(), cell.data(), &tag);
    return detail::finish(status, tag);
}

inline returns<std::tuple<leafless::point_table, uint8_t>> point_table::make(const leafless::octree &octree,
    uint8_t level) {
    leafless_point_table *table_handle = nullptr;
    uint8_t table_level{};
    const leafless_status status = leafless_point_table_new(octree.get(), level, &table_handle, &table_level);
    return detail::finish(status, std::tuple<leafless::point_table,
        uint8_t>(leafless::point_table(table_handle), table_level));
}

inline returns<leafless_membership> point_table::contains(const point &point_model) const {
    leafless_membership membership{};
    const leafless_status status = leafless_point_table_contains(get(), point_model.data(), &membership);
    return detail::finish(status, membership);
}

inline returns<void> point_table::contains_many(span<const point> points_model,
    span<leafless_membership> memberships) const {
    detail::same_size(points_model.size(), memberships.size());
    const leafless_status status = leafless_point_table_contains_many(get(), detail::numbers(points_model),
        points_model.size(), memberships.data());
    return detail::finish(status);
}

inline returns<leafless::cursor> cursor::make(const leafless::octree &octree) {
    leafless_cursor *cursor_handle = nullptr;
    const leafless_status status = leafless_cursor_new(octree.get(), &cursor_handle);
    return detail::finish(status, leafless::cursor(cursor_handle));
}

inline returns<leafless_cursor_info> cursor::describe() const {
    leafless_cursor_info state = LEAFLESS_INIT(leafless_cursor_info);
    const leafless_status status = leafless_cursor_describe(get(), &state);
    return detail::finish(status, state);
}

inline returns<bool> cursor::descend(uint32_t octant) {
    bool moved{};
    const leafless_status status = leafless_cursor_descend(get(), octant, &moved);
    return detail::finish(status, moved);
}

inline returns<bool> cursor::ascend() {
    bool moved{};
    const leafless_status status = leafless_cursor_ascend(get(), &moved);
    return detail::finish(status, moved);
}

inline returns<bool> cursor::seek(const cell_index &cell, uint32_t level) {
    bool reached{};
    const leafless_status status = leafless_cursor_seek(get(), cell.data(), level, &reached);
    return detail::finish(status, reached);
}

inline returns<std::tuple<leafless_cell,
    bool>> cursor::neighbour(const std::array<int32_t,3> &direction) const {
    leafless_cell neighbour{};
    bool exists{};
    const leafless_status status = leafless_cursor_neighbour(get(), direction.data(), &neighbour, &exists);
    return detail::finish(status, std::tuple<leafless_cell, bool>(neighbour, exists));
}

inline returns<std::vector<leafless_cell>> cursor::neighbours(const std::array<int32_t,3> &direction) const {
    std::uint64_t count = 0;
    std::vector<leafless_cell> cells;
    leafless_status status = leafless_cursor_neighbours(get(), direction.data(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        cells.resize(static_cast<std::size_t>(count));
        status = leafless_cursor_neighbours(get(), direction.data(), cells.data(), cells.size(), &count);
    }
    return detail::finish(status, std::move(cells));
}

inline returns<leafless::cells> cells::make(const leafless::octree &octree, uint32_t tags, uint32_t min_level,
    uint32_t max_level, const cell_index *min_cell, const cell_index *max_cell) {
    leafless_cells *cells_handle = nullptr;
    const leafless_status status = leafless_cells_new(octree.get(), tags, min_level, max_level,
        min_cell == nullptr ? nullptr : min_cell->data(), max_cell == nullptr ? nullptr : max_cell->data(),
        &cells_handle);
    return detail::finish(status, leafless::cells(cells_handle));
}

inline returns<void> cells::seek(const cell_index &cell, uint32_t level) {
    const leafless_status status = leafless_cells_seek(get(), cell.data(), level);
    return detail::finish(status);
}

inline returns<uint64_t> cells::next(span<leafless_cell> buffer) {
    uint64_t count{};
    const leafless_status status = leafless_cells_next(get(), buffer.data(), buffer.size(), &count);
    return detail::finish(status, count);
}

inline returns<leafless::faces> faces::make(const leafless::octree &octree, uint32_t tags, uint32_t min_level,
    uint32_t max_level, const cell_index *min_cell, const cell_index *max_cell) {
    leafless_faces *faces_handle = nullptr;
    const leafless_status status = leafless_faces_new(octree.get(), tags, min_level, max_level,
        min_cell == nullptr ? nullptr : min_cell->data(), max_cell == nullptr ? nullptr : max_cell->data(),
        &faces_handle);
    return detail::finish(status, leafless::faces(faces_handle));
}

inline returns<void> faces::seek(const cell_index &cell, uint32_t level) {
    const leafless_status status = leafless_faces_seek(get(), cell.data(), level);
    return detail::finish(status);
}

inline returns<uint64_t> faces::next(span<leafless_boundary_face> buffer) {
    uint64_t count{};
    const leafless_status status = leafless_faces_next(get(), buffer.data(), buffer.size(), &count);
    return detail::finish(status, count);
}

inline returns<std::tuple<std::vector<uint64_t>,
    std::vector<leafless_run>>> columns::copy(leafless_obstacle on) const {
    std::uint64_t offset_count = 0;
    std::vector<uint64_t> offsets;
    std::uint64_t run_count = 0;
    std::vector<leafless_run> runs;
    leafless_status status = leafless_columns_copy(get(), on, nullptr, 0, &offset_count, nullptr, 0,
        &run_count);
    if (status == LEAFLESS_OK) {
        offsets.resize(static_cast<std::size_t>(offset_count));
        runs.resize(static_cast<std::size_t>(run_count));
        status = leafless_columns_copy(get(), on, offsets.data(), offsets.size(), &offset_count, runs.data(),
            runs.size(), &run_count);
    }
    return detail::finish(status, std::tuple<std::vector<uint64_t>,
        std::vector<leafless_run>>(std::move(offsets), std::move(runs)));
}

inline returns<leafless::bay> bay::make(const leafless::solid &container, double clearance_model,
    double wall_clearance_model) {
    leafless_bay *bay_handle = nullptr;
    const leafless_status status = leafless_bay_new(container.get(), clearance_model, wall_clearance_model,
        &bay_handle);
    return detail::finish(status, leafless::bay(bay_handle));
}

inline returns<uint64_t> bay::add_obstacle(const leafless::solid &solid) {
    uint64_t number{};
    const leafless_status status = leafless_bay_add_obstacle(get(), solid.get(), &number);
    return detail::finish(status, number);
}

inline returns<uint64_t> bay::add_item(const leafless::solid &solid, uint32_t count,
    const leafless_item_options *item) {
    uint64_t number{};
    const leafless_status status = leafless_bay_add_item(get(), solid.get(), count, item, &number);
    return detail::finish(status, number);
}

inline returns<leafless::layout> layout::make(const leafless::bay &bay, const leafless_options *options) {
    leafless_layout *layout_handle = nullptr;
    const leafless_status status = leafless_layout_new(bay.get(), options, &layout_handle);
    return detail::finish(status, leafless::layout(layout_handle));
}

inline returns<uint64_t> layout::place(uint64_t item, const affine &matrix) {
    uint64_t number{};
    const leafless_status status = leafless_layout_place(get(), item, matrix.data(), &number);
    return detail::finish(status, number);
}

inline returns<void> layout::move_to(uint64_t number, const affine &matrix) {
    const leafless_status status = leafless_layout_move_to(get(), number, matrix.data());
    return detail::finish(status);
}

inline returns<void> layout::remove(uint64_t number) {
    const leafless_status status = leafless_layout_remove(get(), number);
    return detail::finish(status);
}

inline returns<std::vector<leafless_placement>> layout::placements() const {
    std::uint64_t count = 0;
    std::vector<leafless_placement> placements;
    leafless_status status = leafless_layout_placements(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        placements.resize(static_cast<std::size_t>(count));
        status = leafless_layout_placements(get(), placements.data(), placements.size(), &count);
    }
    return detail::finish(status, std::move(placements));
}

inline returns<leafless_placement> layout::placement_at(uint64_t number) const {
    leafless_placement placement{};
    const leafless_status status = leafless_layout_placement_at(get(), number, &placement);
    return detail::finish(status, placement);
}

inline returns<leafless_standing> layout::check(uint64_t number, const leafless_options *options,
    span<leafless_neighbour> conflicts) const {
    leafless_standing standing = LEAFLESS_INIT(leafless_standing);
    const leafless_status status = leafless_layout_check(get(), number, options, conflicts.data(),
        conflicts.size(), &standing);
    return detail::finish(status, standing);
}

inline returns<std::vector<leafless_placed_standing>> layout::check_all(const leafless_options *options) const {
    std::uint64_t count = 0;
    std::vector<leafless_placed_standing> standings;
    leafless_status status = leafless_layout_check_all(get(), options, nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        standings.resize(static_cast<std::size_t>(count));
        status = leafless_layout_check_all(get(), options, standings.data(), standings.size(), &count);
    }
    return detail::finish(status, std::move(standings));
}

inline returns<leafless_search_report> layout::search(const leafless_search_options *search,
    const leafless_options *options) {
    leafless_search_report report = LEAFLESS_INIT(leafless_search_report);
    const leafless_status status = leafless_layout_search(get(), search, options, &report);
    return detail::finish(status, report);
}

inline returns<leafless_layout_measures> layout::measure(double relative,
    const leafless_options *options) const {
    leafless_layout_measures measures = LEAFLESS_INIT(leafless_layout_measures);
    const leafless_status status = leafless_layout_measure(get(), relative, options, &measures);
    return detail::finish(status, measures);
}

inline returns<leafless::lazy> lazy::make(const leafless::solid &solid, const leafless_frame &frame) {
    leafless_lazy *lazy_handle = nullptr;
    const leafless_status status = leafless_lazy_new(solid.get(), &frame, &lazy_handle);
    return detail::finish(status, leafless::lazy(lazy_handle));
}

inline returns<leafless::lazy> lazy::resume(const leafless::octree &octree, const leafless::solid &solid,
    const leafless_frame &frame, const leafless_options *options) {
    leafless_lazy *lazy_handle = nullptr;
    const leafless_status status = leafless_lazy_resume(octree.get(), solid.get(), &frame, options,
        &lazy_handle);
    return detail::finish(status, leafless::lazy(lazy_handle));
}

inline returns<std::array<leafless_tag,8>> lazy::split(const cell_index &cell, uint32_t level) {
    std::array<leafless_tag,8> tags{};
    const leafless_status status = leafless_lazy_split(get(), cell.data(), level, tags.data());
    return detail::finish(status, tags);
}

inline returns<bool> lazy::refine(const leafless_zone *zone, uint32_t level,
    const leafless_options *options) {
    bool done{};
    const leafless_status status = leafless_lazy_refine(get(), zone, level, options, &done);
    return detail::finish(status, done);
}

inline returns<std::tuple<leafless_tag, bool>> lazy::tag_at(const cell_index &cell, uint32_t level) const {
    leafless_tag tag{};
    bool can_split{};
    const leafless_status status = leafless_lazy_tag_at(get(), cell.data(), level, &tag, &can_split);
    return detail::finish(status, std::tuple<leafless_tag, bool>(tag, can_split));
}

inline returns<leafless_membership> lazy::contains(const point &point_model) const {
    leafless_membership membership{};
    const leafless_status status = leafless_lazy_contains(get(), point_model.data(), &membership);
    return detail::finish(status, membership);
}

inline returns<leafless_lazy_info> lazy::describe() const {
    leafless_lazy_info info = LEAFLESS_INIT(leafless_lazy_info);
    const leafless_status status = leafless_lazy_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<std::vector<leafless_statistics>> lazy::levels() const {
    std::uint64_t count = 0;
    std::vector<leafless_statistics> levels;
    leafless_status status = leafless_lazy_levels(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        levels.resize(static_cast<std::size_t>(count));
        status = leafless_lazy_levels(get(), levels.data(), levels.size(), &count);
    }
    return detail::finish(status, std::move(levels));
}

inline returns<std::vector<uint64_t>> lazy::splits() const {
    std::uint64_t count = 0;
    std::vector<uint64_t> splits;
    leafless_status status = leafless_lazy_splits(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        splits.resize(static_cast<std::size_t>(count));
        status = leafless_lazy_splits(get(), splits.data(), splits.size(), &count);
    }
    return detail::finish(status, std::move(splits));
}

inline returns<leafless::octree> lazy::freeze(const leafless_options *options) const {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_lazy_freeze(get(), options, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::attribute> attribute::new_constant(const double *value, uint32_t components) {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_new_constant(value, components, &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless::attribute> attribute::placed(const affine &matrix) const {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_placed(get(), matrix.data(), &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless_attribute_info> attribute::describe() const {
    leafless_attribute_info info = LEAFLESS_INIT(leafless_attribute_info);
    const leafless_status status = leafless_attribute_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<void> attribute::values(span<const point> points_model, span<double> values) const {
    const std::size_t components = detail::components_of(get());
    detail::at_least(points_model.size() * components, values.size());
    const leafless_status status = leafless_attribute_values(get(), detail::numbers(points_model),
        points_model.size(), values.data());
    return detail::finish(status);
}

inline returns<leafless_value_range> attribute::range(const point &min_model, const point &max_model) const {
    leafless_value_range range{};
    const leafless_status status = leafless_attribute_range(get(), min_model.data(), max_model.data(),
        &range);
    return detail::finish(status, range);
}

inline returns<leafless::attribute> attribute::share() const {
    leafless_attribute *reference_handle = nullptr;
    const leafless_status status = leafless_attribute_ref(get(), &reference_handle);
    return detail::finish(status, leafless::attribute(reference_handle));
}

inline returns<leafless::attribute> attribute::new_callbacks(const leafless_attribute_callbacks &callbacks) {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_new_callbacks(&callbacks, &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless::attribute> attribute::from_mesh(const leafless::mesh &mesh, std::string_view name) {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_from_mesh(mesh.get(), name.data(), name.size(),
        &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless::attribute> attribute::from_mesh_values(const leafless::mesh &mesh,
    span<const double> values, uint32_t components, bool per_corner) {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_from_mesh_values(mesh.get(), values.data(),
        values.size(), components, per_corner, &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless::attribute> attribute::from_channel(const leafless::channel &channel) {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_from_channel(channel.get(), &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless::attribute> attribute::from_volume(const leafless::volume &volume,
    leafless_interpolation interpolation, const leafless_options *options) {
    leafless_attribute *attribute_handle = nullptr;
    const leafless_status status = leafless_attribute_from_volume(volume.get(), interpolation, options,
        &attribute_handle);
    return detail::finish(status, leafless::attribute(attribute_handle));
}

inline returns<leafless::channel> channel::share() const {
    leafless_channel *reference_handle = nullptr;
    const leafless_status status = leafless_channel_ref(get(), &reference_handle);
    return detail::finish(status, leafless::channel(reference_handle));
}

inline returns<leafless_channel_info> channel::describe() const {
    leafless_channel_info info = LEAFLESS_INIT(leafless_channel_info);
    const leafless_status status = leafless_channel_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<void> channel::check() const {
    const leafless_status status = leafless_channel_check(get());
    return detail::finish(status);
}

inline returns<bool> channel::equal(const leafless::channel &b) const {
    bool equal{};
    const leafless_status status = leafless_channel_equal(get(), b.get(), &equal);
    return detail::finish(status, equal);
}

inline returns<leafless::channel> channel::with_metadata(std::string_view key, std::string_view value) const {
    leafless_channel *named_handle = nullptr;
    const leafless_status status = leafless_channel_with_metadata(get(), key.data(), key.size(), value.data(),
        value.size(), &named_handle);
    return detail::finish(status, leafless::channel(named_handle));
}

inline returns<leafless::channel> channel::without_metadata(std::string_view key) const {
    leafless_channel *unnamed_handle = nullptr;
    const leafless_status status = leafless_channel_without_metadata(get(), key.data(), key.size(),
        &unnamed_handle);
    return detail::finish(status, leafless::channel(unnamed_handle));
}

inline returns<std::string_view> channel::peek_metadata(std::string_view key) const {
    const char *value = nullptr;
    std::size_t value_length = 0;
    const leafless_status status = leafless_channel_peek_metadata(get(), key.data(), key.size(), &value,
        &value_length);
    return detail::finish(status, detail::text(value, value_length));
}

inline returns<std::tuple<uint64_t, std::string_view,
    std::string_view>> channel::peek_metadata_at(uint64_t index) const {
    uint64_t count{};
    const char *key = nullptr;
    std::size_t key_length = 0;
    const char *value = nullptr;
    std::size_t value_length = 0;
    const leafless_status status = leafless_channel_peek_metadata_at(get(), index, &count, &key, &key_length,
        &value, &value_length);
    return detail::finish(status, std::tuple<uint64_t, std::string_view, std::string_view>(count,
        detail::text(key, key_length), detail::text(value, value_length)));
}

inline returns<leafless::channel> channel::fill(const leafless::attribute &attribute,
    const leafless_frame &frame, const leafless_channel_fill_options *fill, const leafless_options *options) {
    leafless_channel *channel_handle = nullptr;
    const leafless_status status = leafless_channel_fill(attribute.get(), &frame, fill, options,
        &channel_handle);
    return detail::finish(status, leafless::channel(channel_handle));
}

inline returns<void> channel::values(span<const point> points_model, span<double> values) const {
    const std::size_t components = detail::components_of(get());
    detail::at_least(points_model.size() * components, values.size());
    const leafless_status status = leafless_channel_values(get(), detail::numbers(points_model),
        points_model.size(), values.data());
    return detail::finish(status);
}

inline returns<std::array<double,4>> channel::value(const point &point_model) const {
    std::array<double,4> value{};
    const leafless_status status = leafless_channel_value(get(), point_model.data(), value.data());
    return detail::finish(status, value);
}

inline returns<std::array<double,4>> channel::value_at(const cell_index &cell) const {
    std::array<double,4> value{};
    const leafless_status status = leafless_channel_value_at(get(), cell.data(), value.data());
    return detail::finish(status, value);
}

inline returns<leafless::channel> channel::with_value_in(const leafless::octree &region, const double *value,
    const leafless_options *options) const {
    leafless_channel *changed_handle = nullptr;
    const leafless_status status = leafless_channel_with_value_in(get(), region.get(), value, options,
        &changed_handle);
    return detail::finish(status, leafless::channel(changed_handle));
}

inline returns<leafless_channel_summary> channel::summarise(const leafless::octree *solid,
    const point &min_model, const point &max_model, const leafless_options *options) const {
    leafless_channel_summary summary = LEAFLESS_INIT(leafless_channel_summary);
    const leafless_status status = leafless_channel_summarise(get(), detail::handle_of(solid),
        min_model.data(), max_model.data(), options, &summary);
    return detail::finish(status, summary);
}

inline returns<leafless::octree> channel::region(const double *low, const double *high,
    const leafless_options *options) const {
    leafless_octree *octree_handle = nullptr;
    const leafless_status status = leafless_channel_region(get(), low, high, options, &octree_handle);
    return detail::finish(status, leafless::octree(octree_handle));
}

inline returns<leafless::boundary> boundary::share() const {
    leafless_boundary *reference_handle = nullptr;
    const leafless_status status = leafless_boundary_ref(get(), &reference_handle);
    return detail::finish(status, leafless::boundary(reference_handle));
}

inline returns<leafless_boundary_report> boundary::describe() const {
    leafless_boundary_report report = LEAFLESS_INIT(leafless_boundary_report);
    const leafless_status status = leafless_boundary_describe(get(), &report);
    return detail::finish(status, report);
}

inline returns<leafless::mesh> boundary::mesh() const {
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_boundary_mesh(get(), &mesh_handle);
    return detail::finish(status, leafless::mesh(mesh_handle));
}

inline returns<std::vector<leafless_boundary_surface>> boundary::surfaces() const {
    std::uint64_t count = 0;
    std::vector<leafless_boundary_surface> surfaces;
    leafless_status status = leafless_boundary_surfaces(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        surfaces.resize(static_cast<std::size_t>(count));
        status = leafless_boundary_surfaces(get(), surfaces.data(), surfaces.size(), &count);
    }
    return detail::finish(status, std::move(surfaces));
}

inline returns<std::vector<leafless_boundary_region>> boundary::regions() const {
    std::uint64_t count = 0;
    std::vector<leafless_boundary_region> regions;
    leafless_status status = leafless_boundary_regions(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        regions.resize(static_cast<std::size_t>(count));
        status = leafless_boundary_regions(get(), regions.data(), regions.size(), &count);
    }
    return detail::finish(status, std::move(regions));
}

inline returns<std::vector<uint32_t>> boundary::triangle_regions() const {
    std::uint64_t count = 0;
    std::vector<uint32_t> regions;
    leafless_status status = leafless_boundary_triangle_regions(get(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        regions.resize(static_cast<std::size_t>(count));
        status = leafless_boundary_triangle_regions(get(), regions.data(), regions.size(), &count);
    }
    return detail::finish(status, std::move(regions));
}

inline returns<leafless_polyhedron_arrays> boundary::peek_faces() const {
    leafless_polyhedron_arrays arrays = LEAFLESS_INIT(leafless_polyhedron_arrays);
    const leafless_status status = leafless_boundary_peek_faces(get(), &arrays);
    return detail::finish(status, arrays);
}

inline returns<leafless::tridexel> tridexel::build(const leafless::solid &solid, const leafless_frame &frame,
    leafless_rule rule, const leafless_tridexel_format *format, const leafless_options *options) {
    leafless_tridexel *tridexel_handle = nullptr;
    const leafless_status status = leafless_tridexel_build(solid.get(), &frame, rule, format, options,
        &tridexel_handle);
    return detail::finish(status, leafless::tridexel(tridexel_handle));
}

inline returns<leafless::tridexel> tridexel::share() const {
    leafless_tridexel *reference_handle = nullptr;
    const leafless_status status = leafless_tridexel_ref(get(), &reference_handle);
    return detail::finish(status, leafless::tridexel(reference_handle));
}

inline returns<leafless_tridexel_info> tridexel::describe() const {
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    const leafless_status status = leafless_tridexel_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<void> tridexel::check() const {
    const leafless_status status = leafless_tridexel_check(get());
    return detail::finish(status);
}

inline returns<bool> tridexel::equal(const leafless::tridexel &b) const {
    bool equal{};
    const leafless_status status = leafless_tridexel_equal(get(), b.get(), &equal);
    return detail::finish(status, equal);
}

inline returns<leafless::tridexel> tridexel::with_metadata(std::string_view key,
    std::string_view value) const {
    leafless_tridexel *named_handle = nullptr;
    const leafless_status status = leafless_tridexel_with_metadata(get(), key.data(), key.size(),
        value.data(), value.size(), &named_handle);
    return detail::finish(status, leafless::tridexel(named_handle));
}

inline returns<leafless::tridexel> tridexel::without_metadata(std::string_view key) const {
    leafless_tridexel *unnamed_handle = nullptr;
    const leafless_status status = leafless_tridexel_without_metadata(get(), key.data(), key.size(),
        &unnamed_handle);
    return detail::finish(status, leafless::tridexel(unnamed_handle));
}

inline returns<std::string_view> tridexel::peek_metadata(std::string_view key) const {
    const char *value = nullptr;
    std::size_t value_length = 0;
    const leafless_status status = leafless_tridexel_peek_metadata(get(), key.data(), key.size(), &value,
        &value_length);
    return detail::finish(status, detail::text(value, value_length));
}

inline returns<std::tuple<uint64_t, std::string_view,
    std::string_view>> tridexel::peek_metadata_at(uint64_t index) const {
    uint64_t count{};
    const char *key = nullptr;
    std::size_t key_length = 0;
    const char *value = nullptr;
    std::size_t value_length = 0;
    const leafless_status status = leafless_tridexel_peek_metadata_at(get(), index, &count, &key, &key_length,
        &value, &value_length);
    return detail::finish(status, std::tuple<uint64_t, std::string_view, std::string_view>(count,
        detail::text(key, key_length), detail::text(value, value_length)));
}

inline returns<leafless::tridexel> tridexel::make(const leafless_frame &frame,
    const leafless_tridexel_format *format, span<const leafless_tridexel_arrays> rays,
    const leafless_options *options) {
    leafless_tridexel *tridexel_handle = nullptr;
    const leafless_status status = leafless_tridexel_new(&frame, format, rays.data(), rays.size(), options,
        &tridexel_handle);
    return detail::finish(status, leafless::tridexel(tridexel_handle));
}

inline returns<leafless_dexel_statistics> tridexel::statistics(uint32_t axis) const {
    leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
    const leafless_status status = leafless_tridexel_statistics(get(), axis, &statistics);
    return detail::finish(status, statistics);
}

inline returns<bool> tridexel::contains_cell(const cell_index &cell) const {
    bool inside{};
    const leafless_status status = leafless_tridexel_contains_cell(get(), cell.data(), &inside);
    return detail::finish(status, inside);
}

inline returns<std::tuple<ray_index, ray_index>> tridexel::window(uint32_t axis) const {
    ray_index first{};
    ray_index end{};
    const leafless_status status = leafless_tridexel_window(get(), axis, first.data(), end.data());
    return detail::finish(status, std::tuple<ray_index, ray_index>(first, end));
}

inline returns<std::vector<leafless_dexel>> tridexel::ray(uint32_t axis, const ray_index *ray) const {
    std::uint64_t count = 0;
    std::vector<leafless_dexel> dexels;
    leafless_status status = leafless_tridexel_ray(get(), axis, ray == nullptr ? nullptr : ray->data(),
        nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        dexels.resize(static_cast<std::size_t>(count));
        status = leafless_tridexel_ray(get(), axis, ray == nullptr ? nullptr : ray->data(), dexels.data(),
            dexels.size(), &count);
    }
    return detail::finish(status, std::move(dexels));
}

inline returns<void> tridexel::copy(uint32_t axis, const uint32_t *first, const uint32_t *end,
    uint64_t *offsets, uint64_t offset_capacity, uint64_t *offset_count, double *ends_model, double *normals,
    uint32_t *surfaces, uint32_t *materials, uint64_t interval_capacity, uint64_t *interval_count) const {
    const leafless_status status = leafless_tridexel_copy(get(), axis, first, end, offsets, offset_capacity,
        offset_count, ends_model, normals, surfaces, materials, interval_capacity, interval_count);
    return detail::finish(status);
}

inline returns<std::vector<std::array<double,2>>> tridexel::copy_cells(uint32_t axis, const ray_index *first,
    const ray_index *end) const {
    std::uint64_t interval_count = 0;
    std::vector<std::array<double,2>> ends_cells;
    leafless_status status = leafless_tridexel_copy_cells(get(), axis,
        first == nullptr ? nullptr : first->data(), end == nullptr ? nullptr : end->data(), nullptr, 0,
        &interval_count);
    if (status == LEAFLESS_OK) {
        ends_cells.resize(static_cast<std::size_t>(interval_count));
        status = leafless_tridexel_copy_cells(get(), axis, first == nullptr ? nullptr : first->data(),
            end == nullptr ? nullptr : end->data(), detail::numbers(ends_cells), ends_cells.size(),
            &interval_count);
    }
    return detail::finish(status, std::move(ends_cells));
}

inline returns<leafless::tridexel> tridexel::combine(leafless_operation operation,
    span<const leafless_tridexel *const> tridexels, const leafless_options *options) {
    leafless_tridexel *result_handle = nullptr;
    const leafless_status status = leafless_tridexel_combine(operation, tridexels.data(), tridexels.size(),
        options, &result_handle);
    return detail::finish(status, leafless::tridexel(result_handle));
}

inline returns<leafless::tridexel> tridexel::complement(const leafless_options *options) const {
    leafless_tridexel *result_handle = nullptr;
    const leafless_status status = leafless_tridexel_complement(get(), options, &result_handle);
    return detail::finish(status, leafless::tridexel(result_handle));
}

inline returns<leafless::tridexel> tridexel::with_format(const leafless_tridexel_format *format,
    const leafless_options *options) const {
    leafless_tridexel *result_handle = nullptr;
    const leafless_status status = leafless_tridexel_with_format(get(), format, options, &result_handle);
    return detail::finish(status, leafless::tridexel(result_handle));
}

inline returns<leafless::tridexel> tridexel::with_material(uint32_t material,
    const leafless_options *options) const {
    leafless_tridexel *result_handle = nullptr;
    const leafless_status status = leafless_tridexel_with_material(get(), material, options, &result_handle);
    return detail::finish(status, leafless::tridexel(result_handle));
}

inline returns<std::tuple<leafless_dexel_surface_report,
    leafless::mesh>> tridexel::surface(leafless_dexel_surface_method method,
    const leafless_options *options) const {
    leafless_dexel_surface_report report = LEAFLESS_INIT(leafless_dexel_surface_report);
    leafless_mesh *mesh_handle = nullptr;
    const leafless_status status = leafless_tridexel_surface(get(), method, options, &report, &mesh_handle);
    return detail::finish(status, std::tuple<leafless_dexel_surface_report, leafless::mesh>(report,
        leafless::mesh(mesh_handle)));
}

inline returns<std::vector<leafless_long_voxel>> tridexel::voxels(const leafless_options *options,
    span<const std::array<uint8_t,4>> colours) const {
    std::uint64_t count = 0;
    std::vector<leafless_long_voxel> voxels;
    leafless_status status = leafless_tridexel_voxels(get(), options, detail::numbers(colours),
        colours.size(), nullptr, 0, &count);
    if (status == LEAFLESS_OK) {
        voxels.resize(static_cast<std::size_t>(count));
        status = leafless_tridexel_voxels(get(), options, detail::numbers(colours), colours.size(),
            voxels.data(), voxels.size(), &count);
    }
    return detail::finish(status, std::move(voxels));
}

inline returns<leafless::tridexel> tridexel::read(const leafless_source &source) {
    leafless_tridexel *tridexel_handle = nullptr;
    const leafless_status status = leafless_tridexel_read(&source, &tridexel_handle);
    return detail::finish(status, leafless::tridexel(tridexel_handle));
}

inline returns<void> tridexel::write(const leafless_sink &sink) const {
    const leafless_status status = leafless_tridexel_write(get(), &sink);
    return detail::finish(status);
}

inline returns<leafless::tridexel_editor> tridexel_editor::make(const leafless::tridexel &tridexel) {
    leafless_tridexel_editor *editor_handle = nullptr;
    const leafless_status status = leafless_tridexel_editor_new(tridexel.get(), &editor_handle);
    return detail::finish(status, leafless::tridexel_editor(editor_handle));
}

inline returns<leafless_tridexel_info> tridexel_editor::describe() const {
    leafless_tridexel_info info = LEAFLESS_INIT(leafless_tridexel_info);
    const leafless_status status = leafless_tridexel_editor_describe(get(), &info);
    return detail::finish(status, info);
}

inline returns<leafless_dexel_change> tridexel_editor::combine(leafless_operation operation,
    const leafless::tridexel &tridexel, const leafless_options *options) {
    leafless_dexel_change change = LEAFLESS_INIT(leafless_dexel_change);
    const leafless_status status = leafless_tridexel_editor_combine(get(), operation, tridexel.get(), options,
        &change);
    return detail::finish(status, change);
}

inline returns<leafless_dexel_change> tridexel_editor::combine_solid(leafless_operation operation,
    const leafless::solid &solid, const leafless_options *options) {
    leafless_dexel_change change = LEAFLESS_INIT(leafless_dexel_change);
    const leafless_status status = leafless_tridexel_editor_combine_solid(get(), operation, solid.get(),
        options, &change);
    return detail::finish(status, change);
}

inline returns<leafless::tridexel> tridexel_editor::freeze(const leafless_options *options) const {
    leafless_tridexel *tridexel_handle = nullptr;
    const leafless_status status = leafless_tridexel_editor_freeze(get(), options, &tridexel_handle);
    return detail::finish(status, leafless::tridexel(tridexel_handle));
}

inline returns<leafless::layer> layer::clipped(span<const std::array<double,4>> planes,
    const double *box_model) const {
    leafless_layer *clipped_handle = nullptr;
    const leafless_status status = leafless_layer_clipped(get(), detail::numbers(planes), planes.size(),
        box_model, &clipped_handle);
    return detail::finish(status, leafless::layer(clipped_handle));
}

inline returns<uint64_t> layer::bytes() const {
    uint64_t bytes{};
    const leafless_status status = leafless_layer_bytes(get(), &bytes);
    return detail::finish(status, bytes);
}

inline returns<leafless::layer> layer::share() const {
    leafless_layer *reference_handle = nullptr;
    const leafless_status status = leafless_layer_ref(get(), &reference_handle);
    return detail::finish(status, leafless::layer(reference_handle));
}

inline returns<leafless::layer> layer::from_octree(const leafless::octree &octree,
    const leafless_look *look) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_from_octree(octree.get(), look, &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::from_solid(const leafless::solid &solid, const leafless_frame &frame,
    const leafless_look *look) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_from_solid(solid.get(), &frame, look, &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::from_mesh(const leafless::mesh &mesh, const leafless_look *look) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_from_mesh(mesh.get(), look, &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::new_lines(span<const std::array<double,6>> points_model, double width,
    const uint8_t *colour) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_new_lines(detail::numbers(points_model),
        points_model.size(), width, colour, &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::new_cells(const leafless_frame &frame, span<const leafless_cell> cells,
    double width, const uint8_t *colour) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_new_cells(&frame, cells.data(), cells.size(), width, colour,
        &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::from_octree_slice(const leafless::octree &octree,
    const std::array<double,4> &plane, const leafless_slice_look *look) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_from_octree_slice(octree.get(), plane.data(), look,
        &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::from_solid_slice(const leafless::solid &solid,
    const leafless_frame &frame, const std::array<double,4> &plane, const leafless_slice_look *look) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_from_solid_slice(solid.get(), &frame, plane.data(), look,
        &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline returns<leafless::layer> layer::new_voxels(const leafless_voxel_arrays &voxels,
    const leafless_transfer &transfer, double unit_model) {
    leafless_layer *layer_handle = nullptr;
    const leafless_status status = leafless_layer_new_voxels(&voxels, &transfer, unit_model, &layer_handle);
    return detail::finish(status, leafless::layer(layer_handle));
}

inline uint32_t version() {
    return leafless_version();
}

inline const char *version_string() {
    return leafless_version_string();
}

inline uint32_t abi() {
    return leafless_abi();
}

inline const char *status_name(int32_t status) {
    return leafless_status_name(status);
}

inline returns<void> frame_check(const leafless_frame &frame) {
    const leafless_status status = leafless_frame_check(&frame);
    return detail::finish(status);
}

inline returns<leafless_frame> frame_around(const point &min_model, const point &max_model, uint32_t depth) {
    leafless_frame frame{};
    const leafless_status status = leafless_frame_around(min_model.data(), max_model.data(), depth, &frame);
    return detail::finish(status, frame);
}

inline returns<leafless_frame> frame_to_tolerance(const point &min_model, const point &max_model,
    double tolerance_model, double relative) {
    leafless_frame frame{};
    const leafless_status status = leafless_frame_to_tolerance(min_model.data(), max_model.data(),
        tolerance_model, relative, &frame);
    return detail::finish(status, frame);
}

inline returns<leafless_frame> frame_aligned(const point &min_model, const point &max_model, uint32_t depth) {
    leafless_frame frame{};
    const leafless_status status = leafless_frame_aligned(min_model.data(), max_model.data(), depth, &frame);
    return detail::finish(status, frame);
}

inline returns<leafless_frame> frame_with_cells(const point &min_model, const point &max_model,
    double cell_size_model) {
    leafless_frame frame{};
    const leafless_status status = leafless_frame_with_cells(min_model.data(), max_model.data(),
        cell_size_model, &frame);
    return detail::finish(status, frame);
}

inline returns<leafless_frame> frame_fitted(const point &min_model, const point &max_model, uint32_t depth) {
    leafless_frame frame{};
    const leafless_status status = leafless_frame_fitted(min_model.data(), max_model.data(), depth, &frame);
    return detail::finish(status, frame);
}

inline returns<double> frame_cell_size(const leafless_frame &frame) {
    double cell_size_model{};
    const leafless_status status = leafless_frame_cell_size(&frame, &cell_size_model);
    return detail::finish(status, cell_size_model);
}

inline returns<cell_index> frame_cell_at(const leafless_frame &frame, const point &point_model) {
    cell_index cell{};
    const leafless_status status = leafless_frame_cell_at(&frame, point_model.data(), cell.data());
    return detail::finish(status, cell);
}

inline returns<leafless_interval> frame_plane(const leafless_frame &frame, uint32_t axis, uint32_t index) {
    leafless_interval plane_model{};
    const leafless_status status = leafless_frame_plane(&frame, axis, index, &plane_model);
    return detail::finish(status, plane_model);
}

inline returns<std::tuple<point, point>> frame_cell_bounds(const leafless_frame &frame,
    const cell_index &cell, uint32_t level) {
    point min_model{};
    point max_model{};
    const leafless_status status = leafless_frame_cell_bounds(&frame, cell.data(), level, min_model.data(),
        max_model.data());
    return detail::finish(status, std::tuple<point, point>(min_model, max_model));
}

inline returns<leafless_mass_sum> mass_sum_unknown(const leafless_frame &frame, uint32_t level,
    uint64_t code) {
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum);
    const leafless_status status = leafless_mass_sum_unknown(&frame, level, code, &sum);
    return detail::finish(status, sum);
}

inline returns<leafless_mass_sum> mass_sum_add(const leafless_mass_sum &a, const leafless_mass_sum &b) {
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum);
    const leafless_status status = leafless_mass_sum_add(&a, &b, &sum);
    return detail::finish(status, sum);
}

inline returns<leafless_mass_sum> mass_sum_subtract(const leafless_mass_sum &a, const leafless_mass_sum &b) {
    leafless_mass_sum sum = LEAFLESS_INIT(leafless_mass_sum);
    const leafless_status status = leafless_mass_sum_subtract(&a, &b, &sum);
    return detail::finish(status, sum);
}

inline returns<leafless_measures> mass_sum_measures(const leafless_mass_sum &sum) {
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    const leafless_status status = leafless_mass_sum_measures(&sum, &measures);
    return detail::finish(status, measures);
}

inline returns<uint64_t> voxels_find(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, const cell_index &cell, uint32_t level) {
    uint64_t index{};
    const leafless_status status = leafless_voxels_find(&lattice, codes, levels, kinds.data(), kinds.size(),
        cell.data(), level, &index);
    return detail::finish(status, index);
}

inline returns<std::vector<uint64_t>> voxels_order(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, const point &from, bool is_eye,
    const leafless_options *options) {
    std::uint64_t order_count = 0;
    std::vector<uint64_t> order;
    leafless_status status = leafless_voxels_order(&lattice, codes, levels, kinds.data(), kinds.size(),
        from.data(), is_eye, options, nullptr, 0, &order_count);
    if (status == LEAFLESS_OK) {
        order.resize(static_cast<std::size_t>(order_count));
        status = leafless_voxels_order(&lattice, codes, levels, kinds.data(), kinds.size(), from.data(),
            is_eye, options, order.data(), order.size(), &order_count);
    }
    return detail::finish(status, std::move(order));
}

inline returns<void> voxels_moved(const leafless_frame *lattice, const uint64_t *codes, const uint8_t *levels,
    const leafless_voxel_kind *kinds, uint64_t count, const int32_t *axes, const int32_t *offset_cells,
    const leafless_options *options, uint64_t *moved_codes, uint8_t *moved_levels,
    leafless_voxel_kind *moved_kinds, uint64_t *sources, uint64_t capacity, uint64_t *moved_count) {
    const leafless_status status = leafless_voxels_moved(lattice, codes, levels, kinds, count, axes,
        offset_cells, options, moved_codes, moved_levels, moved_kinds, sources, capacity, moved_count);
    return detail::finish(status);
}

inline returns<std::tuple<std::vector<uint64_t>,
    std::vector<uint32_t>>> voxels_triangles(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, const leafless::mesh &mesh,
    const leafless_options *options) {
    std::uint64_t offset_count = 0;
    std::vector<uint64_t> offsets;
    std::uint64_t triangle_count = 0;
    std::vector<uint32_t> triangles;
    leafless_status status = leafless_voxels_triangles(&lattice, codes, levels, kinds.data(), kinds.size(),
        mesh.get(), options, nullptr, 0, &offset_count, nullptr, 0, &triangle_count);
    if (status == LEAFLESS_OK) {
        offsets.resize(static_cast<std::size_t>(offset_count));
        triangles.resize(static_cast<std::size_t>(triangle_count));
        status = leafless_voxels_triangles(&lattice, codes, levels, kinds.data(), kinds.size(), mesh.get(),
            options, offsets.data(), offsets.size(), &offset_count, triangles.data(), triangles.size(),
            &triangle_count);
    }
    return detail::finish(status, std::tuple<std::vector<uint64_t>, std::vector<uint32_t>>(std::move(offsets),
        std::move(triangles)));
}

inline returns<leafless_file_info> file_describe(const leafless_source &source,
    span<leafless_file_section> sections) {
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    const leafless_status status = leafless_file_describe(&source, &probe, sections.data(), sections.size());
    return detail::finish(status, probe);
}

inline returns<void> file_verify(const leafless_source &source) {
    const leafless_status status = leafless_file_verify(&source);
    return detail::finish(status);
}

inline returns<leafless_camera> camera_fitted(span<const point> points_model, double azimuth_degrees,
    double elevation_degrees, double field_of_view_degrees, double aspect) {
    leafless_camera camera{};
    const leafless_status status = leafless_camera_fitted(detail::numbers(points_model), points_model.size(),
        azimuth_degrees, elevation_degrees, field_of_view_degrees, aspect, &camera);
    return detail::finish(status, camera);
}

inline returns<std::array<uint8_t,4>> transfer_colour(const leafless_transfer &transfer, const double *value,
    uint32_t components) {
    std::array<uint8_t,4> colour{};
    const leafless_status status = leafless_transfer_colour(&transfer, value, components, colour.data());
    return detail::finish(status, colour);
}

inline returns<void> voxels_solid_parts(const leafless_frame &lattice, const uint64_t *codes,
    const uint8_t *levels, span<const leafless_voxel_kind> kinds, const leafless::solid &solid,
    const leafless_options *options, span<double> parts) {
    detail::same_size(kinds.size(), parts.size());
    const leafless_status status = leafless_voxels_solid_parts(&lattice, codes, levels, kinds.data(),
        kinds.size(), solid.get(), options, parts.data());
    return detail::finish(status);
}

inline returns<std::tuple<point, point>> shot_line_of_sight(const leafless_shot &shot, double x, double y) {
    point from_model{};
    point direction{};
    const leafless_status status = leafless_shot_line_of_sight(&shot, x, y, from_model.data(),
        direction.data());
    return detail::finish(status, std::tuple<point, point>(from_model, direction));
}

inline returns<void> picture_render(const leafless_shot &shot, span<const leafless_layer *const> layers,
    const leafless_options *options, span<uint8_t> colours, span<float> depths) {
    const leafless_status status = leafless_picture_render(&shot, layers.data(), layers.size(), options,
        colours.data(), colours.size(), depths.data(), depths.size());
    return detail::finish(status);
}

inline returns<void> picture_write(span<const uint8_t> colours, uint32_t width, uint32_t height,
    const leafless_sink &sink) {
    detail::at_least(std::size_t{4} * width * height, colours.size());
    const leafless_status status = leafless_picture_write(colours.data(), width, height, &sink);
    return detail::finish(status);
}

inline returns<leafless_legend_box> picture_draw_bar(span<uint8_t> colours, uint32_t width, uint32_t height,
    std::string_view title, const leafless_transfer &transfer, leafless_legend_side side) {
    detail::at_least(std::size_t{4} * width * height, colours.size());
    leafless_legend_box covered{};
    const leafless_status status = leafless_picture_draw_bar(colours.data(), width, height, title.data(),
        title.size(), &transfer, side, &covered);
    return detail::finish(status, covered);
}

inline returns<leafless_legend_box> picture_draw_names(span<uint8_t> colours, uint32_t width, uint32_t height,
    std::string_view title, span<const leafless_legend_name> names, leafless_legend_side side) {
    detail::at_least(std::size_t{4} * width * height, colours.size());
    leafless_legend_box covered{};
    const leafless_status status = leafless_picture_draw_names(colours.data(), width, height, title.data(),
        title.size(), names.data(), names.size(), side, &covered);
    return detail::finish(status, covered);
}

// ---- functions of the host ----------------------------------------------------------------------------------

/// The lower and the upper corner of a box.
using box = std::array<double, 6>;

namespace detail {

/// has_classify<T, A...> and so on: true if a const T has a member of this name that can be called with arguments A.
#define LEAFLESS_HAS_MEMBER(member)                                                                            \
    template <class Void, class T, class... A> struct has_##member##_ : std::false_type {};                    \
    template <class T, class... A>                                                                             \
    struct has_##member##_<std::void_t<decltype(std::declval<const T &>().member(std::declval<A>()...))>, T, A...> \
        : std::true_type {};                                                                                   \
    template <class T, class... A> constexpr bool has_##member = has_##member##_<void, T, A...>::value;
LEAFLESS_HAS_MEMBER(classify)
LEAFLESS_HAS_MEMBER(classify_many)
LEAFLESS_HAS_MEMBER(contains)
LEAFLESS_HAS_MEMBER(contains_many)
LEAFLESS_HAS_MEMBER(distance_many)
LEAFLESS_HAS_MEMBER(gradient)
LEAFLESS_HAS_MEMBER(tangent)
LEAFLESS_HAS_MEMBER(value)
LEAFLESS_HAS_MEMBER(values)
LEAFLESS_HAS_MEMBER(range)
#undef LEAFLESS_HAS_MEMBER

template <class T> const T &object_at(void *ctx) noexcept { return *static_cast<const T *>(ctx); }
template <class T> void destroy(void *ctx) {
    forget(ctx);
    delete static_cast<T *>(ctx);
}
inline point point_at(const double *numbers) noexcept { return {numbers[0], numbers[1], numbers[2]}; }
inline span<const point> points_at(const double *numbers, std::uint64_t count) noexcept {
    return {reinterpret_cast<const point *>(numbers), static_cast<std::size_t>(count)};
}
template <class T> span<T> array_at(T *first, std::uint64_t count) noexcept {
    return {first, static_cast<std::size_t>(count)};
}

} // namespace detail

/// Makes a solid from the host's own shape, which lives until the library no longer needs it. The shape is a function
/// that classifies the box between two corners (leafless_tag), or an object with some of the members below. They are
/// const, and are called from several threads at once; the C function type documents each:
///
///     leafless_tag classify(const point &min, const point &max)                          leafless_classify_fn
///     bool contains(const point &at)                                                     leafless_contains_fn
///     void classify_many(span<const box> boxes, span<std::int32_t> tags)            leafless_classify_many_fn
///     void contains_many(span<const point> points, span<std::int32_t> inside)       leafless_contains_many_fn
///     void distance_many(span<const point> points, span<double> distances)          leafless_distance_many_fn
///     void gradient(const point &min, const point &max, const point &middle, leafless_gradient &)
///     void tangent(const point &min, const point &max, const point &middle, leafless_tangent &)
///
/// `promises` has the fields that are not functions: the exterior, a box, a fingerprint.
template <class S> returns<solid> solid_of(S shape, leafless_solid_callbacks promises) {
    auto owned = std::make_unique<S>(std::move(shape));
    leafless_solid_callbacks callbacks = promises;
    callbacks.ctx = owned.get();
    callbacks.destroy = detail::destroy<S>;
    if constexpr (std::is_invocable_v<const S &, const point &, const point &>) {
        callbacks.classify = [](void *ctx, const double *min, const double *max) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                return detail::object_at<S>(ctx)(detail::point_at(min), detail::point_at(max));
            });
        };
    }
    if constexpr (detail::has_classify<S, const point &, const point &>) {
        callbacks.classify = [](void *ctx, const double *min, const double *max) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                return detail::object_at<S>(ctx).classify(detail::point_at(min), detail::point_at(max));
            });
        };
    }
    if constexpr (detail::has_classify_many<S, span<const box>, span<std::int32_t>>) {
        callbacks.classify_many = [](void *ctx, const double *boxes, std::uint64_t count,
                                     std::int32_t *tags) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                const span<const box> all(reinterpret_cast<const box *>(boxes), static_cast<std::size_t>(count));
                detail::object_at<S>(ctx).classify_many(all, detail::array_at(tags, count));
                return 0;
            });
        };
    }
    if constexpr (detail::has_contains<S, const point &>) {
        callbacks.contains = [](void *ctx, const double *at) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                return detail::object_at<S>(ctx).contains(detail::point_at(at)) ? 1 : 0;
            });
        };
    }
    if constexpr (detail::has_contains_many<S, span<const point>, span<std::int32_t>>) {
        callbacks.contains_many = [](void *ctx, const double *points, std::uint64_t count,
                                     std::int32_t *inside) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                detail::object_at<S>(ctx).contains_many(detail::points_at(points, count),
                                                        detail::array_at(inside, count));
                return 0;
            });
        };
    }
    if constexpr (detail::has_distance_many<S, span<const point>, span<double>>) {
        callbacks.distance_many = [](void *ctx, const double *points, std::uint64_t count,
                                     double *distances) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                detail::object_at<S>(ctx).distance_many(detail::points_at(points, count),
                                                        detail::array_at(distances, count));
                return 0;
            });
        };
    }
    if constexpr (detail::has_gradient<S, const point &, const point &, const point &, leafless_gradient &>) {
        callbacks.gradient = [](void *ctx, const double *min, const double *max, const double *middle,
                                leafless_gradient *gradient) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                detail::object_at<S>(ctx).gradient(detail::point_at(min), detail::point_at(max),
                                                   detail::point_at(middle), *gradient);
                return 0;
            });
        };
    }
    if constexpr (detail::has_tangent<S, const point &, const point &, const point &, leafless_tangent &>) {
        callbacks.tangent = [](void *ctx, const double *min, const double *max, const double *middle,
                               leafless_tangent *tangent) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                detail::object_at<S>(ctx).tangent(detail::point_at(min), detail::point_at(max),
                                                  detail::point_at(middle), *tangent);
                return 0;
            });
        };
    }
    leafless_solid *made = nullptr;
    const leafless_status status = leafless_solid_new_callbacks(&callbacks, &made);
    if (status == LEAFLESS_OK) static_cast<void>(owned.release()); // The library owns it from here on.
    return detail::finish(status, solid(made));
}

/// Makes the same solid with only a promise about the space outside the universe.
template <class S> returns<solid> solid_of(S shape, leafless_exterior exterior) {
    leafless_solid_callbacks promises = LEAFLESS_INIT(leafless_solid_callbacks);
    promises.exterior = exterior;
    return solid_of(std::move(shape), promises);
}

/// Makes a solid of the points where the host's function is not negative (see leafless_solid_function), from an object
/// with two members, which are const and are called from several threads at once:
///
///     double value(const point &at)                                                         leafless_value_fn
///     leafless_interval range(const point &min, const point &max)                           leafless_range_fn
template <class F> returns<solid> half_space_of(F function) {
    auto owned = std::make_unique<F>(std::move(function));
    leafless_solid_function functions = LEAFLESS_INIT(leafless_solid_function);
    functions.ctx = owned.get();
    functions.destroy = detail::destroy<F>;
    functions.value = [](void *ctx, const double *at, double *value) noexcept -> std::int32_t {
        return detail::guarded(ctx, [&]() -> std::int32_t {
            *value = detail::object_at<F>(ctx).value(detail::point_at(at));
            return 0;
        });
    };
    functions.range = [](void *ctx, const double *min, const double *max,
                         leafless_interval *range) noexcept -> std::int32_t {
        return detail::guarded(ctx, [&]() -> std::int32_t {
            *range = detail::object_at<F>(ctx).range(detail::point_at(min), detail::point_at(max));
            return 0;
        });
    };
    leafless_solid *made = nullptr;
    const leafless_status status = leafless_solid_new_function(&functions, &made);
    if (status == LEAFLESS_OK) static_cast<void>(owned.release());
    return detail::finish(status, solid(made));
}

/// Makes the host's own attribute with `components` numbers a value, from a function that fills the value at a point,
/// or from an object with some of these members, which are const and are called from several threads at once:
///
///     void value(const point &at, span<double> value)                             leafless_attribute_value_fn
///     void values(span<const point> points, span<double> values)                 leafless_attribute_values_fn
///     void range(const point &min, const point &max, leafless_value_range &)      leafless_attribute_range_fn
template <class A> returns<attribute> attribute_of(A object, std::uint32_t components) {
    // The library does not pass the numbers per value to the functions.
    struct host {
        A object;
        std::size_t components;
    };
    auto owned = std::unique_ptr<host>(new host{std::move(object), components});
    leafless_attribute_callbacks callbacks = LEAFLESS_INIT(leafless_attribute_callbacks);
    callbacks.components = components;
    callbacks.ctx = owned.get();
    callbacks.destroy = detail::destroy<host>;
    if constexpr (std::is_invocable_v<const A &, const point &, span<double>>) {
        callbacks.value = [](void *ctx, const double *at, double *value) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                const host &it = detail::object_at<host>(ctx);
                it.object(detail::point_at(at), span<double>(value, it.components));
                return 0;
            });
        };
    }
    if constexpr (detail::has_value<A, const point &, span<double>>) {
        callbacks.value = [](void *ctx, const double *at, double *value) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                const host &it = detail::object_at<host>(ctx);
                it.object.value(detail::point_at(at), span<double>(value, it.components));
                return 0;
            });
        };
    }
    if constexpr (detail::has_values<A, span<const point>, span<double>>) {
        callbacks.values = [](void *ctx, const double *points, std::uint64_t count,
                              double *values) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                const host &it = detail::object_at<host>(ctx);
                const std::size_t size = static_cast<std::size_t>(count) * it.components;
                it.object.values(detail::points_at(points, count), span<double>(values, size));
                return 0;
            });
        };
    }
    if constexpr (detail::has_range<A, const point &, const point &, leafless_value_range &>) {
        callbacks.range = [](void *ctx, const double *min, const double *max,
                             leafless_value_range *range) noexcept -> std::int32_t {
            return detail::guarded(ctx, [&]() -> std::int32_t {
                detail::object_at<host>(ctx).object.range(detail::point_at(min), detail::point_at(max), *range);
                return 0;
            });
        };
    }
    leafless_attribute *made = nullptr;
    const leafless_status status = leafless_attribute_new_callbacks(&callbacks, &made);
    if (status == LEAFLESS_OK) static_cast<void>(owned.release());
    return detail::finish(status, attribute(made));
}

/// Makes a sink that passes the pieces of a file to a function, which takes a span<const std::uint8_t> and must outlive
/// the sink.
template <class F> leafless_sink sink_to(F &take) {
    const leafless_write_fn write = [](void *ctx, const std::uint8_t *bytes,
                                       std::uint64_t count) noexcept -> std::int32_t {
        return detail::guarded(ctx, [&]() -> std::int32_t {
            (*static_cast<F *>(ctx))(detail::array_at(bytes, count));
            return 0;
        });
    };
    return leafless_to_function(write, &take);
}

/// Calls `use` with options that report progress, from 0 to 1, to `hear`, and returns the result of `use`. `hear`
/// returns whether to go on; one thread at a time calls it. An exception of `hear` is thrown again here.
template <class Hear, class Use> auto with_progress(leafless_options options, Hear hear, Use use) {
    struct state {
        Hear hear;
        std::mutex mutex;
        std::exception_ptr exception;
    };
    state shared{std::move(hear), {}, nullptr};
    options.progress_ctx = &shared;
    options.progress = [](void *ctx, double fraction) noexcept -> std::int32_t {
        state &it = *static_cast<state *>(ctx);
        const std::lock_guard<std::mutex> lock(it.mutex);
#ifndef LEAFLESS_NO_EXCEPTIONS
        try {
            return it.hear(fraction) ? 0 : 1;
        } catch (...) {
            it.exception = std::current_exception();
            return 1;
        }
#else
        return it.hear(fraction) ? 0 : 1;
#endif
    };
#ifndef LEAFLESS_NO_EXCEPTIONS
    try {
        return use(static_cast<const leafless_options &>(options));
    } catch (const error &) {
        if (shared.exception) std::rethrow_exception(shared.exception);
        throw;
    }
#else
    return use(static_cast<const leafless_options &>(options));
#endif
}

// ---- iterators ----------------------------------------------------------------------------------------------

/// The remaining elements of an iterator of the library, for a loop: `for (const leafless_cell &cell : each(cells))`.
/// The iterator must outlive the loop, and continues from its position. A failure is thrown from the loop.
template <class Walk, class Element> class walk_range {
public:
    class iterator {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = Element;
        using difference_type = std::ptrdiff_t;
        using pointer = const Element *;
        using reference = const Element &;

        iterator() noexcept = default;
        explicit iterator(Walk &walk) : walk_(&walk), found_(256) { fill(); }
        reference operator*() const noexcept { return found_[at_]; }
        pointer operator->() const noexcept { return &found_[at_]; }
        iterator &operator++() {
            if (++at_ == count_) fill();
            return *this;
        }
        void operator++(int) { ++*this; }
        bool operator==(const iterator &other) const noexcept { return walk_ == other.walk_; }
        bool operator!=(const iterator &other) const noexcept { return walk_ != other.walk_; }

    private:
        void fill() {
            at_ = 0;
#ifndef LEAFLESS_NO_EXCEPTIONS
            count_ = static_cast<std::size_t>(walk_->next(found_));
#else
            auto found = walk_->next(found_);
            count_ = found ? static_cast<std::size_t>(found.value()) : 0;
#endif
            if (count_ == 0) walk_ = nullptr;
        }

        Walk *walk_ = nullptr;
        std::vector<Element> found_;
        std::size_t at_ = 0, count_ = 0;
    };

    explicit walk_range(Walk &walk) noexcept : walk_(&walk) {}
    iterator begin() const { return iterator(*walk_); }
    iterator end() const noexcept { return iterator(); }

private:
    Walk *walk_;
};

/// Returns the remaining cells of an iterator.
inline walk_range<cells, leafless_cell> each(cells &walk) noexcept { return walk_range<cells, leafless_cell>(walk); }

/// Returns the remaining boundary faces of an iterator.
inline walk_range<faces, leafless_boundary_face> each(faces &walk) noexcept {
    return walk_range<faces, leafless_boundary_face>(walk);
}

} // namespace leafless

#endif // LEAFLESS_HPP
