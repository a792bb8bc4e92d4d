/* A wrench in, contact and grip out. */
#include <fingertip.h>
#include <stdio.h>
static const char *scene =
    "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n"
    "[contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.6\n"
    "[grip]\nleast_N = 0.3\ngreatest_N = 15.0\nrise_N_per_s = 200.0\nfall_N_per_s = 2.0\n";

int main(void) {
    ft_tip *tip = NULL;
    ft_error error;
    if (ft_tip_from_scene(scene, &tip, &error) != FT_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    ft_wrench wrench = {{0.5, 0.0, -2.0}, {0.0, 0.0065, 0.0}};
    ft_touch touch;
    ft_beside beside;
    if (ft_sense_wrench(tip, &wrench, 1e-3, &touch) != FT_OK || ft_beside_last(tip, &beside) != FT_OK) {
        fprintf(stderr, "%s\n", ft_tip_message(tip));
    } else if (touch.resolution != FT_CONTACT) {
        printf("no contact: %s\n", ft_resolution_text(touch.resolution));
    } else {
        printf("contact %.1f mm above the middle of the ball\n", touch.point[2] * 1e3);
        printf("it presses with %.2f N, %.2f N from slipping\n", touch.normal_force, touch.margin);
        printf("grip with %.2f N next\n", beside.grip_force);
    }
    ft_tip_free(&tip);
    return 0;
}
