// The part of the controller that needs nothing of ROS: contacts, zeros, and readings that are none.
#include <cmath>
#include <cstdio>
#include <fingertip_broadcaster/feeler.hpp>
#include <fstream>
#include <limits>

using fingertip_broadcaster::Feeler;
using fingertip_broadcaster::Zero;

static int failed = 0;

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            std::printf("%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            ++failed; \
        } \
    } while (false)

static const char* const scene = R"(version = 2
[input]
convention = "on_fingertip"
[surface]
shape = "sphere"
radius_m = 0.013
[contact]
least_force_N = 0.1
[friction]
static_coefficient = 0.5
)";

// 2 N into the top of the sphere, and 0.3 N across.
static const std::array<double, 6> press{0.3, 0.0, -2.0, 0.0, 0.3 * 0.013, 0.0};
static const std::array<double, 6> bias{0.5, -1.0, 3.0, 0.01, 0.02, -0.03};

static std::array<double, 6> plus(std::array<double, 6> one, const std::array<double, 6>& other) {
    for (std::size_t axis = 0; axis < 6; ++axis) one[axis] += other[axis];
    return one;
}

static bool is_press(const std::optional<fingertip::Touch>& touch) {
    if (!touch || !touch->contact() || !touch->slip_margin()) return false;
    const auto contact = *touch->contact();
    return std::abs(contact.point[2] - 0.013) < 1e-9 && std::abs(contact.normal_force - 2.0) < 1e-9 &&
           std::abs(touch->slip_margin()->utilisation - 0.3) < 1e-9;
}

int main(int, char** arguments) {
    const std::string path = std::string(arguments[0]) + ".toml";
    std::ofstream(path) << scene;
    auto made = Feeler::from_file(path, 0.05);
    CHECK(bool(made));
    if (!made) return std::puts(made.error().message()), 1;
    Feeler& feeler = *made;
    CHECK(is_press(feeler.update(press, 1e-3)));

    // A zero of fifty samples; then the bias counts no more.
    CHECK(feeler.zero() == Zero::none);
    feeler.begin_zero();
    int silent = 0;
    for (int sample = 0; sample < 60 && !feeler.update(bias, 1e-3); ++sample) ++silent;
    CHECK(silent >= 50 && silent <= 51);
    CHECK(feeler.zero() == Zero::taken);
    CHECK(std::abs(feeler.zero_wrench()->force[2] - 3.0) < 1e-12);
    CHECK(is_press(feeler.update(plus(press, bias), 1e-3)));

    // A zero of what are no numbers leaves the one before.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    feeler.begin_zero();
    for (int sample = 0; sample < 60; ++sample) feeler.update({nan, 0, 0, 0, 0, 0}, 1e-3);
    CHECK(feeler.zero() == Zero::failed);
    CHECK(is_press(feeler.update(plus(press, bias), 1e-3)));
    const auto none = feeler.update({nan, 0, 0, 0, 0, 0}, 1e-3);
    CHECK(!none || none->resolution == FT_NOT_FINITE);
    const auto weak = feeler.update(plus({0.0, 0.0, -0.05, 0.0, 0.0, 0.0}, bias), 1e-3);
    CHECK(weak && std::string(fingertip_broadcaster::word(weak->resolution)) == "below_threshold");
    feeler.start_anew();
    CHECK(is_press(feeler.update(plus(press, bias), 1e-3)));

    auto missing = Feeler::from_file(path + ".none", 1.0);
    CHECK(!missing && missing.error().status() == FT_UNREADABLE);
    std::remove(path.c_str());
    if (failed == 0) std::puts("all hold");
    return failed == 0 ? 0 : 1;
}
