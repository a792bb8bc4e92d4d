// A wrench in, contact and grip out.
#include <fingertip.hpp>
#include <iostream>

static const char* const scene = R"(
version = 2
[input]
convention = "on_fingertip"
[surface]
shape = "sphere"
radius_m = 0.013
[contact]
model = "soft_finger"
least_force_N = 0.1
[friction]
static_coefficient = 0.6
[grip]
least_N = 0.3
greatest_N = 15.0
rise_N_per_s = 200.0
fall_N_per_s = 2.0
)";

int main() {
    auto tip = fingertip::Tip::from_scene(scene);
    if (!tip) {
        std::cerr << tip.error().message() << '\n';
        return 1;
    }
    const auto touch = tip->sense_wrench(fingertip::wrench({0.5, 0.0, -2.0}, {0.0, 0.0065, 0.0}), 1e-3);
    if (!touch) {
        std::cerr << tip->message() << '\n';
        return 1;
    }
    if (const auto contact = touch->contact()) {
        std::cout << "contact at " << contact->point[0] << ' ' << contact->point[1] << ' ' << contact->point[2]
                  << " m\nit presses with " << contact->normal_force << " N";
        if (const auto margin = touch->slip_margin()) std::cout << ", " << margin->newtons << " N from slipping";
        std::cout << "\ngrip with " << tip->beside()->grip_force << " N next\n";
    } else {
        std::cout << "no contact: " << touch->text() << '\n';
    }
}
