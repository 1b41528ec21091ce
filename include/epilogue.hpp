
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
