// fingertip for C++17: handles that free themselves, views, optional contacts. A layer over fingertip.h without code of
// its own to link; what that header says of units, threads and failures holds here.
//
// No exception is thrown but by `or_throw()`, which asks for one. With Eigen's headers in reach, `map` shows the vectors
// of all structures as Eigen's, without a copy.
#ifndef FINGERTIP_HPP
#define FINGERTIP_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "fingertip.h"

#if defined(__cpp_exceptions)
#include <stdexcept>
#endif

#if !defined(FINGERTIP_NO_EIGEN) && defined(__has_include)
#if __has_include(<Eigen/Core>)
#include <Eigen/Core>
#define FINGERTIP_HAS_EIGEN 1
#endif
#endif

namespace fingertip {

/// A view of values that lie one behind the other: of an array, or of anything with `data()` and `size()`.
template <typename T>
class View {
public:
    constexpr View() noexcept = default;
    constexpr View(T* data, std::size_t size) noexcept : data_(data), size_(size) {}
    template <std::size_t N>
    constexpr View(T (&array)[N]) noexcept : data_(array), size_(N) {}
    template <typename Container,
              typename = std::enable_if_t<std::is_convertible_v<decltype(std::declval<Container&>().data()), T*>>>
    constexpr View(Container&& container) noexcept : data_(container.data()), size_(container.size()) {}

    constexpr T* data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr T* begin() const noexcept { return data_; }
    constexpr T* end() const noexcept { return data_ + size_; }
    constexpr T& operator[](std::size_t index) const noexcept { return data_[index]; }

private:
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

/// Why something could not be made. Holds its sentence itself.
class Error {
public:
    Error() noexcept : raw_{} {}
    ft_error* raw() noexcept { return &raw_; }
    ft_status status() const noexcept { return raw_.status; }
    /// A sentence that names what was wrong and how to mend it.
    const char* message() const noexcept { return raw_.message; }

private:
    ft_error raw_;
};

/// Something that was made, or why it was not.
template <typename T>
class [[nodiscard]] Made {
public:
    Made(std::optional<T> value, const Error& error) noexcept : value_(std::move(value)), error_(error) {}
    explicit operator bool() const noexcept { return value_.has_value(); }
    /// Only if it was made.
    T& operator*() noexcept { return *value_; }
    T* operator->() noexcept { return &*value_; }
    std::optional<T>& value() noexcept { return value_; }
    /// Of something that was made, the sentence says what is hardly meant, or nothing.
    const Error& error() const noexcept { return error_; }
#if defined(__cpp_exceptions)
    /// What was made, or a `std::runtime_error` with the sentence.
    T or_throw() && {
        if (!value_) throw std::runtime_error(error_.message());
        return std::move(*value_);
    }
#endif

private:
    std::optional<T> value_;
    Error error_;
};

/// What a call gives, if its status is FT_OK. The sentence of a failure is the `message()` of the handle.
template <typename T>
struct [[nodiscard]] Result {
    ft_status status;
    T value;

    explicit operator bool() const noexcept { return status == FT_OK; }
    const T& operator*() const noexcept { return value; }
    const T* operator->() const noexcept { return &value; }
    const char* text() const noexcept { return ft_status_text(status); }
#if defined(__cpp_exceptions)
    /// The value, or a `std::runtime_error`.
    const T& or_throw() const {
        if (status != FT_OK) throw std::runtime_error(ft_status_text(status));
        return value;
    }
#endif
};

using Vector = std::array<double, 3>;

inline Vector vector(const double (&numbers)[3]) noexcept { return {numbers[0], numbers[1], numbers[2]}; }

/// A force in N and a torque in N·m.
inline ft_wrench wrench(const Vector& force, const Vector& torque) noexcept {
    return {{force[0], force[1], force[2]}, {torque[0], torque[1], torque[2]}};
}

/// A contact on the fingertip, in the sensor frame: m, N, N·m.
struct Contact {
    Vector point;
    Vector normal;
    double normal_force;
    Vector tangential_force;
    double spin_torque;
    double gap;
    std::uint32_t alternatives;
    /// Contacts were searched for, and more may be missing.
    bool searched;
};

/// What a sample says.
struct Touch : ft_touch {
    Touch() noexcept : ft_touch{} { resolution = FT_BELOW_THRESHOLD; }

    /// Where it touches and how, if it does.
    std::optional<Contact> contact() const noexcept {
        if (resolution != FT_CONTACT) return std::nullopt;
        return Contact{vector(point), vector(normal), normal_force, vector(tangential_force),
                       spin_torque,   gap,            alternatives,              searched != 0};
    }
    /// How far it is from slipping, with friction and contact.
    std::optional<ft_margin> slip_margin() const noexcept {
        if (has_margin == 0) return std::nullopt;
        return ft_margin{margin, utilisation};
    }
    bool slips() const noexcept { return slip == FT_SLIPPING; }
    /// That it is a contact, or why it is none.
    const char* text() const noexcept { return ft_resolution_text(resolution); }
};

/// A fingertip: a scene that runs.
class Tip {
public:
    /// Of the text of a scene.
    static Made<Tip> from_scene(const std::string& scene) {
        return make([&](ft_tip** tip, ft_error* error) { return ft_tip_from_scene(scene.c_str(), tip, error); });
    }
    /// Of a scene in a file, and with another calibration than its own, if one is given.
    static Made<Tip> from_file(const std::string& path, const std::optional<std::string>& calibration = std::nullopt) {
        const char* other = calibration ? calibration->c_str() : nullptr;
        return make([&](ft_tip** tip, ft_error* error) { return ft_tip_from_file(path.c_str(), other, tip, error); });
    }
    /// Of numbers.
    static Made<Tip> from_ball(const ft_ball& ball) {
        return make([&](ft_tip** tip, ft_error* error) { return ft_tip_from_ball(&ball, tip, error); });
    }

    Result<Touch> sense(View<const double> gauges, double time_step) noexcept {
        return touch([&](ft_touch* to) { return ft_sense(raw(), gauges.data(), gauges.size(), time_step, to); });
    }
    Result<Touch> sense(const ft_reading& reading, double time_step) noexcept {
        return touch([&](ft_touch* to) { return ft_sense_reading(raw(), &reading, time_step, to); });
    }
    Result<Touch> sense_wrench(const ft_wrench& wrench, double time_step) noexcept {
        return touch([&](ft_touch* to) { return ft_sense_wrench(raw(), &wrench, time_step, to); });
    }
    Result<Touch> sense_wrench(const ft_wrench& wrench, const ft_motion& motion, double time_step) noexcept {
        return touch([&](ft_touch* to) { return ft_sense_wrench_moving(raw(), &wrench, &motion, time_step, to); });
    }
    /// Many wrenches; every column has at least `count` entries.
    ft_status sense_all(const ft_wrench_columns& wrenches, std::size_t count, double time_step,
                        const ft_touch_columns& touches) noexcept {
        return ft_sense_all(raw(), &wrenches, count, time_step, &touches);
    }
    /// What the wrench of the last sample and a tactile array tell together, with [fusion].
    Result<ft_fused> fuse(View<const ft_array_reading> readings) noexcept {
        Result<ft_fused> result{FT_OK, {}};
        result.status = ft_fuse(raw(), readings.data(), readings.size(), &result.value);
        return result;
    }
    /// What the last sample says beside its touch.
    Result<ft_beside> beside() noexcept {
        Result<ft_beside> result{FT_OK, {}};
        result.status = ft_beside_last(raw(), &result.value);
        return result;
    }

    ft_status rest(View<const double> gauges) noexcept { return ft_rest(raw(), gauges.data(), gauges.size()); }
    ft_status rest(const ft_reading& reading) noexcept { return ft_rest_reading(raw(), &reading); }
    ft_status rest_wrench(const ft_wrench& wrench) noexcept { return ft_rest_wrench(raw(), &wrench); }
    ft_status rest_wrench(const ft_wrench& wrench, const ft_motion& motion) noexcept {
        return ft_rest_wrench_moving(raw(), &wrench, &motion);
    }
    ft_status end_rest() noexcept { return ft_end_rest(raw()); }
    /// Why the last rest may have been none, or nothing.
    std::optional<Error> rest_doubt() noexcept {
        Error doubt;
        if (ft_rest_doubt(raw(), doubt.raw()) != FT_DOUBTFUL) return std::nullopt;
        return doubt;
    }
    ft_status set_zero(const ft_reading& reading) noexcept { return ft_set_zero(raw(), &reading); }
    ft_status set_zero_wrench(const ft_wrench& wrench) noexcept { return ft_set_zero_wrench(raw(), &wrench); }
    Result<ft_wrench> zero_wrench() noexcept {
        Result<ft_wrench> result{FT_OK, {}};
        result.status = ft_zero_wrench(raw(), &result.value);
        return result;
    }

    std::size_t gauges() const noexcept { return ft_tip_gauges(raw()); }
    ft_status reset() noexcept { return ft_tip_reset(raw()); }
    ft_status start_anew() noexcept { return ft_tip_start_anew(raw()); }
    /// Why the last call failed that did.
    const char* message() const noexcept { return ft_tip_message(raw()); }
    /// NULL once it was moved from; calls then are FT_NULL.
    ft_tip* raw() const noexcept { return tip_.get(); }

private:
    struct Free {
        void operator()(ft_tip* tip) const noexcept { ft_tip_free(&tip); }
    };
    explicit Tip(ft_tip* tip) noexcept : tip_(tip) {}

    template <typename Call>
    static Made<Tip> make(Call call) {
        ft_tip* tip = nullptr;
        Error error;
        const ft_status status = call(&tip, error.raw());
        return {status == FT_OK ? std::optional<Tip>(Tip(tip)) : std::nullopt, error};
    }
    template <typename Call>
    static Result<Touch> touch(Call call) noexcept {
        Result<Touch> result{FT_OK, {}};
        result.status = call(&result.value);
        return result;
    }

    std::unique_ptr<ft_tip, Free> tip_;
};

/// A finger of a touch, in the frame of the hand.
inline Made<ft_finger> finger(const ft_touch& touch, const ft_pose& hand_from_sensor, double friction,
                              double torque_arm = 0.0) noexcept {
    ft_finger finger{};
    Error error;
    const ft_status status = ft_finger_from_touch(&touch, &hand_from_sensor, friction, torque_arm, &finger, error.raw());
    return {status == FT_OK ? std::optional<ft_finger>(finger) : std::nullopt, error};
}

/// The quality of the grasp of these fingers: see ft_grasp_quality.
inline Made<ft_quality> quality(View<const ft_finger> fingers, double length, bool each = false) noexcept {
    ft_quality quality{};
    Error error;
    const ft_status status =
        ft_grasp_quality(fingers.data(), fingers.size(), length, each ? 1 : 0, &quality, error.raw());
    return {status == FT_OK ? std::optional<ft_quality>(quality) : std::nullopt, error};
}

/// A hand: what it commanded last, what slip has taught it, and what it has learnt of the object.
class Hand {
public:
    static Made<Hand> create(const ft_hand_settings& settings, std::size_t fingers) {
        return make(settings, nullptr, fingers);
    }
    /// With a limit for each finger.
    static Made<Hand> create(const ft_hand_settings& settings, View<const ft_finger_limits> limits) {
        return make(settings, limits.data(), limits.size());
    }

    /// The normal forces to command next. Without a load, it is what the fingers feel together.
    Result<ft_hand_order> command(View<const ft_finger> fingers, double time_step,
                                  const ft_wrench* load = nullptr) noexcept {
        Result<ft_hand_order> result{FT_OK, {}};
        result.status = ft_hand_command(raw(), fingers.data(), fingers.size(), load, time_step, &result.value);
        return result;
    }
    /// The least grip for these fingers.
    Result<ft_grip> least_grip(View<const ft_finger> fingers, const ft_wrench* load = nullptr) noexcept {
        Result<ft_grip> result{FT_OK, {}};
        result.status = ft_hand_least_grip(raw(), fingers.data(), fingers.size(), load, &result.value);
        return result;
    }
    /// What the joints of a finger can give from now on: six numbers of each joint, and its greatest torque.
    ft_status set_joints(std::size_t finger, View<const double> jacobian, View<const double> greatest) noexcept {
        if (jacobian.size() != 6 * greatest.size()) return FT_WRONG_SIZE;
        return ft_hand_set_joints(raw(), finger, jacobian.data(), greatest.data(), greatest.size());
    }
    /// How many times a disturbance can be borne beside a load; without one, beside what the fingers feel together.
    Result<ft_reach> reach(View<const ft_finger> fingers, const ft_wrench& disturbance,
                           const ft_wrench* load = nullptr) noexcept {
        Result<ft_reach> result{FT_OK, {}};
        result.status = ft_hand_reach(raw(), fingers.data(), fingers.size(), load, &disturbance, &result.value);
        return result;
    }
    /// Takes in what the fingers feel together while nothing else touches the object.
    ft_status weigh(const ft_uncertain_wrench& load, const double (&gravity)[3]) noexcept {
        return ft_hand_weigh(raw(), &load, gravity);
    }
    /// What was learnt of the object.
    Result<ft_object> object() noexcept {
        Result<ft_object> result{FT_OK, {}};
        result.status = ft_hand_object(raw(), &result.value);
        return result;
    }
    /// What else touches the object.
    Result<ft_other> other(const ft_uncertain_wrench& load, const double (&gravity)[3],
                           double false_alarm = 1e-3) noexcept {
        Result<ft_other> result{FT_OK, {}};
        result.status = ft_hand_other(raw(), &load, gravity, false_alarm, &result.value);
        return result;
    }
    ft_status forget() noexcept { return ft_hand_forget(raw()); }
    const char* message() const noexcept { return ft_hand_message(raw()); }
    ft_hand* raw() const noexcept { return hand_.get(); }

private:
    struct Free {
        void operator()(ft_hand* hand) const noexcept { ft_hand_free(&hand); }
    };
    explicit Hand(ft_hand* hand) noexcept : hand_(hand) {}

    static Made<Hand> make(const ft_hand_settings& settings, const ft_finger_limits* limits, std::size_t count) {
        ft_hand* hand = nullptr;
        Error error;
        const ft_status status = ft_hand_create(&settings, limits, count, &hand, error.raw());
        return {status == FT_OK ? std::optional<Hand>(Hand(hand)) : std::nullopt, error};
    }

    std::unique_ptr<ft_hand, Free> hand_;
};

#if defined(FINGERTIP_HAS_EIGEN)
/// A vector of a structure as Eigen's, without a copy.
inline Eigen::Map<const Eigen::Vector3d> map(const double (&numbers)[3]) noexcept {
    return Eigen::Map<const Eigen::Vector3d>(numbers);
}
inline Eigen::Map<Eigen::Vector3d> map(double (&numbers)[3]) noexcept { return Eigen::Map<Eigen::Vector3d>(numbers); }
inline Eigen::Map<const Eigen::Vector3d> map(const Vector& vector) noexcept {
    return Eigen::Map<const Eigen::Vector3d>(vector.data());
}
/// A force in N and a torque in N·m.
template <typename Force, typename Torque>
ft_wrench wrench(const Eigen::MatrixBase<Force>& force, const Eigen::MatrixBase<Torque>& torque) noexcept {
    const Eigen::Vector3d f = force, t = torque;
    return {{f.x(), f.y(), f.z()}, {t.x(), t.y(), t.z()}};
}
/// A pose of a rotation matrix and an origin in m.
inline ft_pose pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& origin) noexcept {
    ft_pose pose{};
    for (Eigen::Index row = 0; row < 3; ++row) {
        for (Eigen::Index column = 0; column < 3; ++column) pose.rotation[row][column] = rotation(row, column);
        pose.origin[row] = origin(row);
    }
    return pose;
}
#endif

}  // namespace fingertip

#endif  // FINGERTIP_HPP
