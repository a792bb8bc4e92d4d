/*
 * Three fingertips hold a jar at 1 kHz: wrenches in, contacts, what the jar weighs, and normal forces to command.
 *
 * The sensors are simulated: each feels what it was told to press with, a third of the weight, and finger 1 slips once.
 */
#define _POSIX_C_SOURCE 200809L
#include <fingertip.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

enum { FINGERS = 3, SAMPLES = 500 };
static const double step = 1e-3;        /* s */
static const double radius = 0.04;      /* of the jar, m */
static const double tip_radius = 0.01;  /* m */
static const double mass = 0.3;         /* kg */
static const double friction = 0.6;

/* Finger i looks at the jar's axis: the z axis of its sensor points there, its x axis up. */
static ft_pose pose_of(int finger) {
    const double angle = 2.0943951023931953 * finger;
    const double inward[3] = {-cos(angle), -sin(angle), 0.0};
    const double up[3] = {0.0, 0.0, 1.0};
    const double aside[3] = {inward[1] * up[2] - inward[2] * up[1], inward[2] * up[0] - inward[0] * up[2],
                             inward[0] * up[1] - inward[1] * up[0]};
    ft_pose pose;
    for (int axis = 0; axis < 3; ++axis) {
        pose.rotation[axis][0] = up[axis];
        pose.rotation[axis][1] = aside[axis];
        pose.rotation[axis][2] = inward[axis];
        pose.origin[axis] = -inward[axis] * (radius + tip_radius);
    }
    return pose;
}

/* What the sensor of a finger reports that presses the jar with `normal` N and bears its share of the weight. */
static ft_wrench simulated(double normal, double share) {
    const double down = -mass * 9.80665 * share;
    ft_wrench wrench = {{down, 0.0, -normal}, {0.0, tip_radius * down, 0.0}};
    return wrench;
}

/* What the jar weighs, and how much more could be borne with motors that give 0.5 N m at 4 cm. */
static int weigh(ft_hand *hand, const ft_finger fingers[FINGERS], const ft_wrench *load) {
    /* Off the table, the load is the jar alone: with 2 mN and 20 uN m of noise. */
    ft_uncertain_wrench felt = {*load, {{0}}};
    for (int i = 0; i < 6; ++i) felt.covariance[i][i] = i < 3 ? 4e-6 : 4e-10;
    const double gravity[3] = {0.0, 0.0, -9.80665};
    ft_object object;
    if (ft_hand_weigh(hand, &felt, gravity) != FT_OK || ft_hand_object(hand, &object) != FT_OK) return -1;
    const ft_wrench more = {{0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}};
    for (int i = 0; i < FINGERS; ++i) {
        const ft_pose pose = pose_of(i);
        const double drive[6] = {0.04 * pose.rotation[0][2], 0.04 * pose.rotation[1][2], 0.0, 0.0, 0.0, 0.0};
        const double torque = 0.5;
        if (ft_hand_set_joints(hand, (size_t)i, drive, &torque, 1) != FT_OK) return -1;
    }
    ft_reach reach;
    if (ft_hand_reach(hand, fingers, FINGERS, NULL, &more, &reach) != FT_OK) return -1;
    printf("        the jar is of %.1f g within %.1f g; %.1f N more could be borne\n", 1e3 * object.mass,
           1e3 * object.mass_deviation, reach.times);
    return 0;
}

/* The loop of a controller. Returns how many samples were contacts of all fingers, or a negative number. */
static int hold(ft_tip *tips[FINGERS], ft_hand *hand, double command[FINGERS]) {
    struct timespec next;
    clock_gettime(CLOCK_MONOTONIC, &next);
    int held = 0;
    for (int sample = 0; sample < SAMPLES; ++sample) {
        const double share = (sample < 100 ? sample / 100.0 : 1.0) / FINGERS;
        ft_finger fingers[FINGERS];
        int touching = 0;
        for (int i = 0; i < FINGERS; ++i) {
            const ft_pose pose = pose_of(i);
            const ft_wrench wrench = simulated(command[i], share);
            ft_touch touch;
            ft_error error;
            if (ft_sense_wrench(tips[i], &wrench, step, &touch) != FT_OK) {
                fprintf(stderr, "finger %d: %s\n", i, ft_tip_message(tips[i]));
                return -1;
            }
            if (sample == 300 && i == 1) touch.slip = FT_SLIPPING;
            if (ft_finger_from_touch(&touch, &pose, friction, 0.0, &fingers[i], &error) != FT_OK) {
                fprintf(stderr, "finger %d: %s\n", i, error.message);
                return -1;
            }
            touching += fingers[i].touching == 1;
        }
        held += touching == FINGERS;
        ft_hand_order order;
        if (ft_hand_command(hand, fingers, FINGERS, NULL, step, &order) != FT_OK) {
            fprintf(stderr, "%s\n", ft_hand_message(hand));
            return -1;
        }
        for (int i = 0; i < FINGERS; ++i) command[i] = order.normal_force[i];
        if (sample % 100 == 99) {
            ft_wrench load;
            if (ft_object_wrench(fingers, FINGERS, &load, NULL) != FT_OK) return -1;
            printf("%3d ms: press with %.2f, %.2f, %.2f N; the jar weighs %.2f N; holding: %s\n", sample, command[0],
                   command[1], command[2], -load.force[2], order.state == FT_HAND_HOLDING ? "yes" : "no");
            if (sample > 100 && weigh(hand, fingers, &load) != 0) return -1;
        }
        next.tv_nsec += 1000000;
        if (next.tv_nsec >= 1000000000) {
            next.tv_nsec -= 1000000000;
            ++next.tv_sec;
        }
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
    }
    return held;
}

int main(void) {
    ft_error error;
    ft_ball ball = ft_ball_defaults();
    ball.radius_m = tip_radius;
    ball.static_coefficient = friction;
    ft_tip *tips[FINGERS] = {NULL, NULL, NULL};
    ft_hand *hand = NULL;
    int failed = 0;
    for (int i = 0; i < FINGERS && !failed; ++i) failed = ft_tip_from_ball(&ball, &tips[i], &error) != FT_OK;
    const ft_hand_settings settings = ft_hand_settings_defaults();
    const ft_finger_limits limit = {0.3, 15.0, 1.0};
    const ft_finger_limits limits[FINGERS] = {limit, limit, limit};
    if (!failed) failed = ft_hand_create(&settings, limits, FINGERS, &hand, &error) != FT_OK;
    if (failed) fprintf(stderr, "%s\n", error.message);

    double command[FINGERS] = {0.3, 0.3, 0.3};
    if (!failed) failed = hold(tips, hand, command) != SAMPLES;
    /* A third of the weight each, with friction 0.6 and the safety; slip has made it take 0.48 of finger 1. */
    const double least = mass * 9.80665 / FINGERS * settings.safety / friction;
    for (int i = 0; i < FINGERS && !failed; ++i) failed = !(command[i] > 0.9 * least && command[i] < 2.0 * least);

    ft_hand_free(&hand);
    for (int i = 0; i < FINGERS; ++i) ft_tip_free(&tips[i]);
    /* Whatever pulls: the ball of wrenches that 1 N of grip resists. */
    ft_finger ring[FINGERS];
    for (int i = 0; i < FINGERS; ++i) {
        const ft_pose pose = pose_of(i);
        const ft_finger none = {0};
        ring[i] = none;
        ring[i].touching = 1;
        ring[i].friction = friction;
        for (int axis = 0; axis < 3; ++axis) {
            ring[i].normal[axis] = pose.rotation[axis][2];
            ring[i].point[axis] = -radius * pose.rotation[axis][2];
        }
    }
    ft_quality quality;
    if (!failed) failed = ft_grasp_quality(ring, FINGERS, radius, 0, &quality, &error) != FT_OK;
    if (!failed) printf("1 N of grip resists any %.2f N, but not every %.2f N\n", quality.certified, quality.found);
    puts(failed ? "failed" : "done");
    return failed;
}
