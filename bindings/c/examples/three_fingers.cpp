// Three fingertips hold a jar at 1 kHz, as in three_fingers.c, with handles that free themselves.
#include <array>
#include <chrono>
#include <cmath>
#include <fingertip.hpp>
#include <iostream>
#include <optional>
#include <thread>
#include <vector>

namespace {

constexpr std::size_t fingers = 3;
constexpr double step = 1e-3, radius = 0.04, tip_radius = 0.01, mass = 0.3, friction = 0.6;

/// The z axis of a finger's sensor points at the jar's axis, its x axis up.
ft_pose pose_of(std::size_t finger) {
    const double angle = 2.0943951023931953 * static_cast<double>(finger);
    const double x = -std::cos(angle), y = -std::sin(angle);
    const double away = radius + tip_radius;
    return {{{0.0, y, x}, {0.0, -x, y}, {1.0, 0.0, 0.0}}, {-x * away, -y * away, 0.0}};
}

/// What the sensor of a finger reports that presses the jar and bears its share of the weight.
ft_wrench simulated(double normal, double share) {
    const double down = -mass * 9.80665 * share;
    return fingertip::wrench({down, 0.0, -normal}, {0.0, tip_radius * down, 0.0});
}

bool hold(std::vector<fingertip::Tip>& tips, fingertip::Hand& hand, std::array<double, fingers>& command) {
    auto next = std::chrono::steady_clock::now();
    for (int sample = 0; sample < 500; ++sample) {
        const double share = std::min(sample / 100.0, 1.0) / fingers;
        std::array<ft_finger, fingers> felt{};
        for (std::size_t i = 0; i < fingers; ++i) {
            const auto touch = tips[i].sense_wrench(simulated(command[i], share), step);
            if (!touch || !touch->contact()) return false;
            auto finger = fingertip::finger(*touch, pose_of(i), friction);
            if (!finger) return false;
            felt[i] = *finger;
        }
        const auto order = hand.command(felt, step);
        if (!order || order->state != FT_HAND_HOLDING) return false;
        for (std::size_t i = 0; i < fingers; ++i) command[i] = order->normal_force[i];
        next += std::chrono::milliseconds(1);
        std::this_thread::sleep_until(next);
    }
    return true;
}

}  // namespace

int main() {
    ft_ball ball = ft_ball_defaults();
    ball.radius_m = tip_radius;
    ball.static_coefficient = friction;
    std::vector<fingertip::Tip> tips;
    for (std::size_t i = 0; i < fingers; ++i) {
        auto tip = fingertip::Tip::from_ball(ball);
        if (!tip) {
            std::cerr << tip.error().message() << '\n';
            return 1;
        }
        tips.push_back(std::move(*tip));
    }
    const std::array<ft_finger_limits, fingers> limits{{{0.3, 15.0, 1.0}, {0.3, 15.0, 1.0}, {0.3, 15.0, 1.0}}};
    auto hand = fingertip::Hand::create(ft_hand_settings_defaults(), limits);
    if (!hand) {
        std::cerr << hand.error().message() << '\n';
        return 1;
    }
    std::array<double, fingers> command{0.3, 0.3, 0.3};
    if (!hold(tips, *hand, command)) {
        std::cerr << "it was not held\n";
        return 1;
    }
    std::cout << "press with " << command[0] << ", " << command[1] << ", " << command[2] << " N\n";
    const double least = mass * 9.80665 / fingers * ft_hand_settings_defaults().safety / friction;
    for (const double normal : command) {
        if (!(std::abs(normal / least - 1.0) < 0.01)) return 1;
    }
}
