// What the controller does with a wrench, without anything of ROS.
#pragma once

#include <array>
#include <fingertip.hpp>
#include <optional>
#include <string>
#include <utility>

namespace fingertip_broadcaster {

/// How a call for a zero is going.
enum class Zero { none, resting, taken, failed };

/// How a sample ended, in the words of the message.
inline const char* word(ft_resolution resolution) noexcept {
    switch (resolution) {
        case FT_CONTACT: return "contact";
        case FT_NOT_FINITE: return "not_finite";
        case FT_BELOW_THRESHOLD: return "below_threshold";
        case FT_MISSES: return "misses";
        case FT_ONLY_PULLING: return "only_pulling";
        case FT_BEYOND_FRICTION: return "beyond_friction";
        case FT_OUTSIDE_ACTIVE_REGION: return "outside_active_region";
        default: return "other";
    }
}

/// A fingertip that is asked once in each period of a controller. After it was made nothing allocates, waits or throws.
class Feeler {
public:
    /// Of a scene in a file. It must take wrenches, and no [payload]: how the arm moves is not told here.
    static fingertip::Made<Feeler> from_file(const std::string& scene, double zero_seconds) {
        auto tip = fingertip::Tip::from_file(scene);
        if (!tip) return {std::nullopt, tip.error()};
        return {std::optional<Feeler>(Feeler(std::move(*tip), zero_seconds)), tip.error()};
    }

    /// One sample: the wrench that the sensor reports (N, N m), and the time since the one before (s). Nothing while a
    /// zero is taken, or if the sample cannot be used; `why_not` says which.
    std::optional<fingertip::Touch> update(const std::array<double, 6>& reported, double period) noexcept {
        const auto wrench = fingertip::wrench({reported[0], reported[1], reported[2]}, {reported[3], reported[4], reported[5]});
        if (zero_ == Zero::resting) {
            rest(wrench, period);
            if (zero_ == Zero::resting) return std::nullopt;
        }
        const auto touch = tip_.sense_wrench(wrench, period);
        failed_ = touch.status != FT_OK;
        if (failed_) return std::nullopt;
        return *touch;
    }

    /// Begins a zero: the mean of the samples over the seconds that follow, in which nothing may touch.
    void begin_zero() noexcept {
        rested_ = 0.0;
        zero_ = Zero::resting;
    }

    /// How the last call for a zero is going.
    Zero zero() const noexcept { return zero_; }

    /// What is taken off (N, N m).
    std::optional<ft_wrench> zero_wrench() noexcept {
        const auto zero = tip_.zero_wrench();
        if (!zero) return std::nullopt;
        return *zero;
    }

    /// Forgets the last contact and what detectors saw.
    void start_anew() noexcept { tip_.start_anew(); }

    /// Why the last sample gave nothing: a sentence.
    const char* why_not() const noexcept { return failed_ ? tip_.message() : "a zero is being taken"; }

private:
    Feeler(fingertip::Tip tip, double zero_seconds) noexcept : tip_(std::move(tip)), zero_seconds_(zero_seconds) {}

    void rest(const ft_wrench& wrench, double period) noexcept {
        if (rested_ < zero_seconds_) {
            // A sample that is no number is none of the rest; if all are, the end of the rest says so.
            tip_.rest_wrench(wrench);
            rested_ += period;
            return;
        }
        const ft_status ended = tip_.end_rest();
        zero_ = ended == FT_OK ? Zero::taken : Zero::failed;
    }

    fingertip::Tip tip_;
    double zero_seconds_;
    double rested_ = 0.0;
    Zero zero_ = Zero::none;
    bool failed_ = false;
};

}  // namespace fingertip_broadcaster
