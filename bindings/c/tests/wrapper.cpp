// The wrapper for C++: what it owns is freed once, what was moved from says FT_NULL, and nothing throws unasked.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fingertip.hpp>
#include <string>
#include <vector>

namespace {

int checks = 0;

void check(bool holds, const char* what) {
    ++checks;
    if (!holds) {
        std::fprintf(stderr, "not so: %s\n", what);
        std::exit(1);
    }
}

const char* const gauges = R"(
version = 2
[input]
convention = "on_fingertip"
[sensor]
signal_unit = "V"
load_per_signal_N_Nm = [
    [5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 5.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 5.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.05, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 0.05, 0.0],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.05],
]
[surface]
shape = "sphere"
radius_m = 0.013
[friction]
static_coefficient = 0.6
)";

void owns() {
    auto made = fingertip::Tip::from_scene(gauges);
    check(static_cast<bool>(made) && made->gauges() == 6, "a scene is a tip");
    fingertip::Tip first = std::move(*made);
    fingertip::Tip second = std::move(first);
    // What was moved from is empty on purpose here.
    check(first.raw() == nullptr && second.raw() != nullptr, "a tip moves");  // NOLINT
    const std::array<double, 6> press{0.0, 0.0, -0.2, 0.0, 0.0, 0.0};
    check(first.sense(press, 1e-3).status == FT_NULL, "a tip that was moved from is NULL");  // NOLINT
    check(first.message()[0] != '\0' && first.gauges() == 0, "and says so");  // NOLINT
    first = std::move(second);
    check(first.sense(press, 1e-3)->contact().has_value(), "a tip moves back");
    std::vector<fingertip::Tip> many;
    for (int i = 0; i < 20; ++i) {
        auto tip = fingertip::Tip::from_ball(ft_ball_defaults());
        check(static_cast<bool>(tip), "a ball is a tip");
        many.push_back(std::move(*tip));
    }
    many.erase(many.begin() + 3, many.begin() + 9);
    ft_tip* raw = nullptr;
    check(ft_tip_from_scene(gauges, &raw, nullptr) == FT_OK, "a scene is a handle");
    ft_tip_free(&raw);
    ft_tip_free(&raw);
    check(raw == nullptr, "a handle is freed once");
}

void fails() {
    auto bad = fingertip::Tip::from_scene("nonsense");
    check(!bad && bad.error().status() == FT_BAD_SCENE, "a bad scene is told");
    check(std::string(bad.error().message()).size() > 10, "with a sentence");
    auto none = fingertip::Tip::from_file("/nowhere/at/all.toml");
    check(!none && none.error().status() == FT_UNREADABLE, "a file that there is not is told");
    auto tip = fingertip::Tip::from_scene(gauges);
    const std::vector<double> few(5, 0.0);
    const auto touch = tip->sense(few, 1e-3);
    check(!touch && touch.status == FT_WRONG_SIZE, "five gauges are too few");
    check(std::string(tip->message()).find("5 gauges") != std::string::npos, "and the message counts them");
    check(!touch->contact() && !touch->slip_margin(), "a touch that is none is no contact");
    bool thrown = false;
    try {
        (void)touch.or_throw();
    } catch (const std::runtime_error&) {
        thrown = true;
    }
    check(thrown, "an exception that is asked for is thrown");
    thrown = false;
    try {
        fingertip::Tip asked = fingertip::Tip::from_scene("nonsense").or_throw();
    } catch (const std::runtime_error& error) {
        thrown = std::string(error.what()) == bad.error().message();
    }
    check(thrown, "with the sentence");
    fingertip::Tip good = fingertip::Tip::from_scene(gauges).or_throw();
    check(good.gauges() == 6, "what was made is handed on");
}

void senses() {
    fingertip::Tip tip = fingertip::Tip::from_scene(gauges).or_throw();
    const ft_wrench wrench = fingertip::wrench({0.5, 0.0, -2.0}, {0.0, 0.0065, 0.0});
    const auto touch = tip.sense_wrench(wrench, 1e-3);
    const auto contact = touch->contact();
    check(contact && std::abs(contact->point[2] - 0.013) < 1e-12, "the contact is on top");
    check(std::abs(contact->normal_force - 2.0) < 1e-12, "it presses with 2 N");
    check(touch->slip_margin() && std::abs(touch->slip_margin()->utilisation - 0.5 / 1.2) < 1e-12, "and holds");
    const double signals[6] = {0.1, 0.0, -0.4, 0.0, 0.13, 0.0};
    check(std::abs(tip.sense(signals, 1e-3)->contact()->point[2] - 0.013) < 1e-12, "a reading is the same");
    for (int i = 0; i < 300; ++i) check(tip.rest(signals) == FT_OK, "a rest");
    check(tip.end_rest() == FT_OK && !tip.rest_doubt(), "a rest that is one");
    check(tip.sense(signals, 1e-3)->resolution == FT_BELOW_THRESHOLD, "the zero is taken off");
    check(tip.set_zero(ft_reading_of(std::array<double, 6>{}.data(), 6)) == FT_OK, "a zero is set");
    check(tip.sense(signals, 1e-3)->contact().has_value(), "and is there");
    check(tip.set_zero_wrench(wrench) == FT_OK && tip.zero_wrench()->force[2] == -2.0, "a wrench is set as zero");
    check(!tip.sense_wrench(wrench, 1e-3)->contact(), "and is taken off");
    check(tip.beside()->has_spread == 0 && tip.reset() == FT_OK && tip.start_anew() == FT_OK, "the rest works");

    std::vector<double> zeros(50, 0.0), down(50, -1.0), normal(50, 9.0);
    check(tip.set_zero_wrench(ft_wrench{}) == FT_OK, "no zero");
    const ft_wrench_columns in{zeros.data(), zeros.data(), down.data(), zeros.data(), zeros.data(), zeros.data()};
    ft_touch_columns out{};
    out.normal_force = normal.data();
    check(tip.sense_all(in, normal.size(), 1e-3, out) == FT_OK && normal[49] == 1.0, "columns");
}

#if defined(FINGERTIP_HAS_EIGEN)
void maps() {
    fingertip::Tip tip = fingertip::Tip::from_scene(gauges).or_throw();
    const Eigen::Vector3d force(0.5, 0.0, -2.0), torque(0.0, 0.0065, 0.0), point(0.0, 0.0, 0.013);
    const auto touch = tip.sense_wrench(fingertip::wrench(force, torque), 1e-3);
    check((fingertip::map(touch->point) - point).norm() < 1e-12, "a point is a vector of Eigen's");
    check(fingertip::map(touch->point).data() == touch->point, "without a copy");
    const ft_pose pose = fingertip::pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.1, 0.0, 0.0));
    const auto finger = fingertip::finger(*touch, pose, 0.5).or_throw();
    check(std::abs(finger.point[0] - 0.1) < 1e-12, "a pose is one");
}
#endif

}  // namespace

int main() {
    owns();
    fails();
    senses();
#if defined(FINGERTIP_HAS_EIGEN)
    maps();
    std::printf("%d checks passed, with Eigen\n", checks);
#else
    std::printf("%d checks passed, without Eigen\n", checks);
#endif
}
