/*
 * Random and hostile calls: NULL, wrong sizes, numbers of any bits, texts cut and garbled, handles freed twice. What must
 * hold: no undefined behaviour (the sanitizers and valgrind look), a status that is known, outputs that a failed call
 * leaves as they were, and of a contact a finite place with a normal of length 1.
 *
 *     hostile CALLS [SEED]
 */
#include <fingertip.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t state = 1;

static uint64_t draw(void) { /* xorshift64* */
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return state * 0x2545F4914F6CDD1DULL;
}
static size_t below(size_t n) { return (size_t)((draw() >> 11) % n); }
static bool once_in(size_t n) { return below(n) == 0; }
static double uniform(double size) { return ((double)(draw() >> 11) / 9007199254740992.0 * 2.0 - 1.0) * size; }

static double number(double size) {
    static const double odd[] = {0.0, -0.0, 1.0, -1.0, 5e-324, 2.2e-308, 1e-300, 1e300, 1.7e308, -1.7e308};
    switch (below(12)) {
        case 0: return NAN;
        case 1: return INFINITY;
        case 2: return odd[below(sizeof odd / sizeof *odd)];
        case 3: {
            const uint64_t bits = draw();
            double any;
            memcpy(&any, &bits, sizeof any);
            return any;
        }
        default: return uniform(size);
    }
}

static void fail(const char *call, const char *what) {
    fprintf(stderr, "%s: %s\n", call, what);
    exit(1);
}

static void numbers(void *to, size_t count, double size) {
    for (size_t i = 0; i < count; ++i) {
        const double x = number(size);
        memcpy((char *)to + i * sizeof x, &x, sizeof x);
    }
}

/* Bytes that a failed call must leave, at any alignment. */
enum { ROOM = 4096, CANARY = 0xA5 };
static unsigned char output[ROOM + 64];
static unsigned char *placed;
static void *place(void) {
    memset(output, CANARY, sizeof output);
    placed = once_in(16) ? NULL : output + below(once_in(4) ? 33 : 1);
    return placed;
}
static void check(const char *call, ft_status status, size_t bytes) {
    if (status > FT_INTERNAL) fail(call, "a status that there is not");
    if (status == FT_INTERNAL) fail(call, "a fault of the library");
    if (ft_status_text(status)[0] == '\0') fail(call, "a status without a text");
    size_t changed = 0;
    for (size_t i = 0; i < sizeof output; ++i) changed += output[i] != CANARY;
    if (status != FT_OK && status != FT_DOUBTFUL && changed > 0) fail(call, "a failed call has written");
    if (changed > bytes) fail(call, "more was written than the structure holds");
}

#define HEAD "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\n"
#define ROW(a, b, c, d, e, f) "[" #a ", " #b ", " #c ", " #d ", " #e ", " #f "],\n"
static const char *const scenes[] = {
    HEAD "[surface]\nshape = \"sphere\"\nradius_m = 0.013\n[friction]\nstatic_coefficient = 0.6\n"
         "[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n",
    HEAD "[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = [0.008, 0.010, 0.015]\n[pose]\n"
         "translation_m = [0.0, 0.0, 0.02]\nrotation_deg = [10.0, 20.0, 30.0]\n[contact]\nmodel = \"soft_finger\"\n"
         "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n[tracking]\nspeed_m_per_s = 0.05\nturns_within_s = 0.1\nleast_touch_N = 0.05\n"
         "[friction]\nstatic_coefficient = 0.6\n[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"
         "[estimate]\nnoise_N = 0.01\n[grip]\nleast_N = 0.3\ngreatest_N = 15.0\nrise_N_per_s = 200.0\nfall_N_per_s = 2.0\n",
    "version = 2\n[input]\nconvention = \"reaction\"\nrest_s = 1.0\n[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [\n"
    ROW(0.02, 0.05, -0.08, -3.38, 0.06, 3.35) ROW(-0.09, 4.10, 0.05, -1.95, -0.03, -1.92)
    ROW(3.91, 0.12, 3.72, 0.20, 3.88, 0.10) ROW(0.0004, 0.0005, 0.0322, -0.0003, -0.0331, 0.0002)
    ROW(-0.0370, 0.0001, 0.0187, 0.0004, 0.0190, -0.0005) ROW(-0.0003, -0.0201, 0.0002, -0.0194, 0.0004, -0.0197)
    "]\nrange = [-10.0, 10.0]\n[surface]\nshape = \"capsule\"\nhalf_length_m = 0.01\nradius_m = 0.008\n"
    "[contact]\nleast_force_deviations = 5.0\n",
    HEAD "[surface]\nshape = \"sphere\"\nradius_m = 0.0095\n[contact]\nmodel = \"soft_finger\"\n[uncertainty]\nforce_noise_N = 0.01\n"
         "torque_noise_Nm = 0.0001\n[friction]\nstatic_coefficient = 0.6\n[fusion]\nplaces = 2\nposition_deviation_m = 0.001\n"
         "normal_deviation_N = 0.05\nrelative_deviation = 0.1\n",
    HEAD "[payload]\nmass_kg = 0.1\n[surface]\nshape = \"torus\"\nring_radius_m = 0.02\ntube_radius_m = 0.006\n"
         "[contact]\nmodel = \"soft_finger\"\n",
};
enum { KINDS = sizeof scenes / sizeof *scenes, HELD = 10 };

static ft_tip *tips[HELD];
static ft_hand *hands[HELD];

static ft_tip *some_tip(void) { return once_in(40) ? NULL : tips[below(HELD)]; }
static ft_hand *some_hand(void) { return once_in(40) ? NULL : hands[below(HELD)]; }
static size_t some_count(size_t right) {
    static const size_t odd[] = {0, 1, 5, 7, 17, SIZE_MAX, SIZE_MAX / 8, SIZE_MAX / 16 + 1};
    return once_in(8) ? odd[below(sizeof odd / sizeof *odd)] : right;
}

static ft_wrench some_wrench(void) {
    ft_wrench wrench;
    if (once_in(4)) {
        numbers(&wrench, 6, 5.0);
    } else { /* A push towards the middle. */
        const double at[3] = {uniform(0.006), uniform(0.006), uniform(0.006)};
        const double f[3] = {uniform(0.5), uniform(0.5), -1.0 + uniform(1.2)};
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            wrench.force[i] = f[i];
            wrench.torque[i] = at[j] * f[k] - at[k] * f[j] + uniform(1e-3);
        }
    }
    return wrench;
}

static void some_finger(ft_finger *finger) {
    memset(finger, 0, sizeof *finger);
    if (once_in(6)) {
        numbers(finger, sizeof *finger / sizeof(double), 5.0);
        return;
    }
    const double angle = uniform(3.14159);
    finger->touching = once_in(6) ? 0 : once_in(12) ? 2 : once_in(24) ? (uint32_t)below(5) : 1;
    finger->slip = (uint32_t)below(5);
    finger->point[0] = 0.03 * cos(angle);
    finger->point[1] = 0.03 * sin(angle);
    finger->normal[0] = -cos(angle);
    finger->normal[1] = -sin(angle);
    finger->friction = once_in(12) ? number(1.0) : 0.5;
    finger->torque_arm = once_in(2) ? 0.0 : (once_in(8) ? number(0.01) : 0.002);
    finger->normal_force = once_in(12) ? number(5.0) : 2.0;
    finger->tangential_force[2] = uniform(1.0);
}

static long contacts, others, fused;

static void check_touch(const char *call, ft_status status) {
    ft_touch touch;
    if (status != FT_OK) return;
    memcpy(&touch, placed, sizeof touch);
    if (touch.resolution > FT_OTHER_REASON || ft_resolution_text(touch.resolution)[0] == '\0')
        fail(call, "a resolution that there is not");
    if (touch.slip > FT_SLIPPING) fail(call, "a verdict that there is not");
    others += touch.resolution != FT_CONTACT;
    if (touch.resolution != FT_CONTACT) return;
    ++contacts;
    double square = 0.0;
    for (int i = 0; i < 3; ++i) {
        square += touch.normal[i] * touch.normal[i];
        if (!isfinite(touch.point[i])) fail(call, "a contact that is nowhere");
    }
    if (!(fabs(square - 1.0) < 1e-9)) fail(call, "a normal whose length is not 1");
    /* At grazing the sign of the normal force is that of a rounding error. */
    double size = 0.0;
    for (int i = 0; i < 3; ++i) size = fmax(size, fabs(touch.wrench.force[i]));
    if (!(touch.normal_force >= -1e-12 * size)) {
        fprintf(stderr, "normal force %g N under %g %g %g N, %g %g %g Nm, gap %g m\n", touch.normal_force, touch.wrench.force[0],
                touch.wrench.force[1], touch.wrench.force[2], touch.wrench.torque[0], touch.wrench.torque[1], touch.wrench.torque[2], touch.gap);
        fail(call, "a contact that pulls");
    }
}

static void sense(void) {
    ft_tip *tip = some_tip();
    const double step = once_in(4) ? number(1.0) : 1e-3;
    const size_t gauges = ft_tip_gauges(tip);
    const ft_wrench wrench = some_wrench();
    const ft_wrench *in = once_in(30) ? NULL : &wrench;
    ft_motion motion;
    numbers(&motion, 9, 10.0);
    void *to = place();
    ft_status status;
    double signals[16];
    for (int i = 0; i < 16; ++i) signals[i] = once_in(40) ? number(12.0) : uniform(0.5);
    ft_reading reading = ft_reading_of(once_in(30) ? NULL : signals, some_count(gauges));
    reading.motion = once_in(2) ? NULL : &motion;
    if (once_in(3)) reading.celsius = number(30.0);
    if (once_in(5)) reading.dummy = number(1.0);
    switch (below(4)) {
        case 0: status = ft_sense_wrench(tip, in, step, to); break;
        case 1: status = ft_sense_wrench_moving(tip, in, once_in(30) ? NULL : &motion, step, to); break;
        case 2: status = ft_sense(tip, reading.gauges, reading.count, step, to); break;
        default: status = ft_sense_reading(tip, once_in(30) ? NULL : &reading, step, to); break;
    }
    check("ft_sense", status, sizeof(ft_touch));
    check_touch("ft_sense", status);
    to = place();
    status = ft_beside_last(tip, to);
    check("ft_beside_last", status, sizeof(ft_beside));
}

/* What the wrench of the last sample and a tactile array say together. */
static void fuse(void) {
    ft_tip *tip = some_tip();
    ft_array_reading readings[FT_MAX_PLACES + 1];
    for (int i = 0; i <= FT_MAX_PLACES; ++i) {
        const double up = uniform(1.0), angle = uniform(3.14159), level = sqrt(1.0 - up * up), radius = 0.0095 + uniform(1e-4);
        readings[i] = (ft_array_reading){{radius * level * cos(angle), radius * level * sin(angle), radius * up}, 1.0 + uniform(1.0)};
    }
    if (once_in(4)) numbers(readings, 4 * below(FT_MAX_PLACES + 1), 0.02);
    void *to = place();
    const ft_status status = ft_fuse(tip, once_in(30) ? NULL : readings, some_count(1 + below(FT_MAX_PLACES)), to);
    check("ft_fuse", status, sizeof(ft_fused));
    if (status != FT_OK) return;
    ft_fused told;
    memcpy(&told, placed, sizeof told);
    ++fused;
    if (told.count < 1 || told.count > FT_MAX_PLACES) fail("ft_fuse", "a number of contacts that there cannot be");
    if (!(told.disagreement >= 0.0)) fail("ft_fuse", "a disagreement that is none");
    for (uint32_t i = 0; i < told.count; ++i) {
        const ft_fused_contact *contact = &told.contacts[i];
        if (contact->grip > 2) fail("ft_fuse", "a grip that there is not");
        for (int axis = 0; axis < 3; ++axis) {
            if (!isfinite(contact->point[axis]) || !isfinite(contact->force[axis])) fail("ft_fuse", "a contact that is nowhere");
            if (!(contact->force_covariance[axis][axis] >= 0.0)) fail("ft_fuse", "a variance below zero");
        }
    }
}

static void rest(void) {
    ft_tip *tip = some_tip();
    const ft_wrench wrench = some_wrench();
    ft_motion motion;
    numbers(&motion, 9, 10.0);
    double signals[16];
    numbers(signals, 16, 0.01);
    ft_reading reading = ft_reading_of(signals, some_count(ft_tip_gauges(tip)));
    memset(output, CANARY, sizeof output);
    ft_status status = FT_OK;
    switch (below(9)) {
        case 0: status = ft_rest(tip, once_in(9) ? NULL : signals, reading.count); break;
        case 1: status = ft_rest_reading(tip, once_in(9) ? NULL : &reading); break;
        case 2: status = ft_rest_wrench(tip, once_in(9) ? NULL : &wrench); break;
        case 3: status = ft_rest_wrench_moving(tip, &wrench, once_in(9) ? NULL : &motion); break;
        case 4: status = ft_end_rest(tip); break;
        case 5: status = ft_rest_doubt(tip, place()); break;
        case 6: status = ft_set_zero(tip, once_in(9) ? NULL : &reading); break;
        case 7: status = once_in(4) ? ft_set_zero_wrench(tip, once_in(9) ? NULL : &wrench) : FT_OK; break;
        default: status = ft_zero_wrench(tip, place()); break;
    }
    check("ft_rest", status, sizeof(ft_error));
    if (ft_tip_message(tip)[0] == '\0' && status != FT_OK && status != FT_DOUBTFUL) fail("ft_rest", "no message");
    if (once_in(20)) {
        const ft_wrench none = {{0}, {0}};
        ft_set_zero_wrench(tip, &none);
    }
}

static void columns(void) {
    enum { MOST = 300 };
    static double memory[16 * MOST];
    double *in[6], *out[10];
    for (size_t i = 0; i < 6; ++i) in[i] = memory + i * MOST;
    for (size_t i = 0; i < 10; ++i) out[i] = memory + (6 + i) * MOST;
    const size_t count = once_in(20) ? SIZE_MAX / (1 + below(9)) : below(MOST + 1);
    for (size_t i = 0; i < MOST && count <= MOST; ++i) {
        const ft_wrench wrench = some_wrench();
        for (int axis = 0; axis < 3; ++axis) {
            in[axis][i] = wrench.force[axis];
            in[axis + 3][i] = wrench.torque[axis];
        }
    }
    ft_wrench_columns from = {in[0], in[1], in[2], in[3], in[4], in[5]};
    ft_touch_columns to = {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7], out[8], (uint8_t *)out[9]};
    if (once_in(9)) from.ty = NULL;
    if (once_in(5)) to.margin = NULL;
    if (once_in(5)) to.slip = NULL;
    if (once_in(9)) to.point_y = to.point_z;
    if (once_in(9)) to.point_x = in[0];
    if (once_in(9)) to.utilisation = once_in(2) ? in[3] + 1 : in[3] - 1;
    const ft_status status =
        ft_sense_all(some_tip(), once_in(30) ? NULL : &from, count, once_in(3) ? number(1.0) : 1e-3, once_in(30) ? NULL : &to);
    if (status >= FT_INTERNAL) fail("ft_sense_all", "a status that there is not");
    if (status == FT_OK && count > MOST) fail("ft_sense_all", "it took more samples than memory can hold");
}

static void hand_calls(void) {
    ft_finger fingers[FT_MAX_FINGERS + 1];
    for (int i = 0; i <= FT_MAX_FINGERS; ++i) some_finger(&fingers[i]);
    ft_hand *hand = some_hand();
    const ft_finger *in = once_in(30) ? NULL : fingers;
    const size_t count = some_count(2 + below(4));
    ft_wrench load;
    numbers(&load, 6, 5.0);
    const ft_wrench *loaded = once_in(2) ? NULL : &load;
    void *to = place();
    ft_status status;
    size_t bytes;
    ft_uncertain_wrench felt;
    numbers(&felt, 42, 1.0);
    for (int i = 0; i < 6 && once_in(2); ++i) felt.covariance[i][i] += 8.0;
    double motion[6 * (FT_MAX_JOINTS + 1)], torques[FT_MAX_JOINTS + 1], gravity[3];
    numbers(motion, 6 * (FT_MAX_JOINTS + 1), 1.0);
    numbers(torques, FT_MAX_JOINTS + 1, 1.0);
    numbers(gravity, 3, 9.81);
    switch (below(12)) {
        case 6: memset(output, CANARY, sizeof output), status = ft_hand_weigh(hand, once_in(30) ? NULL : &felt, once_in(30) ? NULL : gravity), bytes = 0; break;
        case 7: status = ft_hand_object(hand, to), bytes = sizeof(ft_object); break;
        case 8: status = ft_hand_other(hand, once_in(30) ? NULL : &felt, once_in(30) ? NULL : gravity, number(0.5), to), bytes = sizeof(ft_other); break;
        case 9: status = ft_hand_reach(hand, in, count, loaded, once_in(30) ? NULL : &felt.wrench, to), bytes = sizeof(ft_reach); break;
        case 10:
            memset(output, CANARY, sizeof output);
            status = ft_hand_set_joints(hand, below(4), once_in(30) ? NULL : motion, once_in(30) ? NULL : torques, below(FT_MAX_JOINTS + 2));
            bytes = 0;
            break;
        case 11: status = once_in(8) ? ft_grasp_quality(in, count, number(0.02), below(3), to, NULL) : ft_hand_object(NULL, to), bytes = sizeof(ft_quality); break;
        case 0: status = ft_hand_command(hand, in, count, loaded, once_in(4) ? number(1.0) : 1e-3, to), bytes = sizeof(ft_hand_order); break;
        case 1: status = ft_hand_least_grip(hand, in, count, loaded, to), bytes = sizeof(ft_grip); break;
        case 2: status = ft_object_wrench(in, count, to, NULL), bytes = sizeof(ft_wrench); break;
        case 3: status = ft_slip_margins(in, count, to, NULL), bytes = FT_MAX_FINGERS * sizeof(ft_margin); break;
        case 4: {
            ft_touch touch;
            ft_pose pose = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.1, 0, 0}};
            unsigned char *raw = (unsigned char *)&touch;
            for (size_t i = 0; i < sizeof touch; ++i) raw[i] = (unsigned char)draw();
            if (once_in(2)) touch.resolution = FT_CONTACT;
            if (once_in(4)) numbers(&pose, 12, 1.0);
            ft_error error;
            status = ft_finger_from_touch(once_in(30) ? NULL : &touch, once_in(30) ? NULL : &pose, number(1.0),
                                          number(0.01), to, once_in(2) ? NULL : &error);
            bytes = sizeof(ft_finger);
            break;
        }
        default: memset(output, CANARY, sizeof output), status = ft_hand_forget(hand), bytes = 0; break;
    }
    check("ft_hand", status, bytes);
    if (hand != NULL && ft_hand_message(hand) == NULL) fail("ft_hand_message", "no text");
}

static void garble(char *text) {
    const size_t length = strlen(text);
    for (size_t turns = below(4); turns > 0; --turns) {
        const size_t at = below(length);
        if (once_in(3)) text[at] = '\0';
        else text[at] = (char)draw();
    }
}

static void create(void) {
    char text[2048];
    strcpy(text, scenes[below(KINDS)]);
    if (once_in(2)) garble(text);
    ft_tip **slot = &tips[below(HELD)];
    ft_tip_free(slot);
    if (*slot != NULL) fail("ft_tip_free", "the variable still holds the handle");
    ft_tip_free(slot); /* Twice. */
    ft_tip_free(NULL);
    ft_error error;
    memset(&error, CANARY, sizeof error);
    ft_ball ball = ft_ball_defaults();
    double matrix[6 * 17];
    numbers(matrix, 6 * 17, 2.0);
    ft_status status;
    switch (below(6)) {
        case 0:
            if (once_in(2)) ball.radius_m = number(0.02);
            if (once_in(2)) ball.static_coefficient = number(1.0);
            ball.soft_finger = (uint32_t)below(3);
            ball.torque_arm_m = 0.002;
            if (once_in(2)) ball.load_per_signal = matrix, ball.gauges = some_count(6);
            status = ft_tip_from_ball(once_in(20) ? NULL : &ball, slot, &error);
            break;
        case 1:
            status = ft_tip_from_file(once_in(9) ? NULL : "/nowhere/\xff.toml", NULL, slot, &error);
            if (status == FT_OK) fail("ft_tip_from_file", "a file that there is not");
            break;
        default: status = ft_tip_from_scene(once_in(30) ? NULL : text, once_in(30) ? NULL : slot, &error); break;
    }
    if (status >= FT_INTERNAL) fail("ft_tip_from", "a status that there is not");
    if ((status == FT_OK) != (*slot != NULL)) fail("ft_tip_from", "a status without its handle");
    if (status != FT_OK && (error.message[0] == '\0' || memchr(error.message, 0, sizeof error.message) == NULL))
        fail("ft_tip_from", "no message");
    if (*slot == NULL && ft_tip_from_scene(scenes[below(KINDS)], slot, NULL) != FT_OK) fail("ft_tip_from_scene", "refused");

    ft_hand **hand = &hands[below(HELD)];
    ft_hand_free(hand);
    ft_hand_free(hand);
    ft_hand_settings settings = ft_hand_settings_defaults();
    ft_finger_limits limits[FT_MAX_FINGERS + 1];
    for (int i = 0; i <= FT_MAX_FINGERS; ++i) limits[i] = (ft_finger_limits){0.3, 15.0, 1.0};
    if (once_in(3)) numbers(&settings, sizeof(settings) / sizeof(double), 5.0);
    if (once_in(3)) numbers(limits, 3 * FT_MAX_FINGERS, 5.0);
    if (ft_hand_create(&settings, once_in(3) ? NULL : limits, some_count(2 + below(4)), hand, &error) != FT_OK) {
        settings = ft_hand_settings_defaults();
        if (ft_hand_create(&settings, NULL, 2 + below(4), hand, NULL) != FT_OK) fail("ft_hand_create", "refused");
    }
}

int main(int count, char **arguments) {
    const long calls = count > 1 ? atol(arguments[1]) : 1000000;
    if (count > 2) state = (uint64_t)atoll(arguments[2]) | 1;
    if (ft_abi_version() != FT_ABI_VERSION || ft_version()[0] == '\0') fail("ft_abi_version", "another library");
    for (int i = 0; i < HELD; ++i) {
        ft_error error;
        if (ft_tip_from_scene(scenes[(size_t)i % KINDS], &tips[i], &error) != FT_OK) fail("a scene", error.message);
    }
    for (int i = 0; i < 40 * HELD; ++i) create();
    for (long call = 0; call < calls; ++call) {
        switch (below(400)) {
            case 0: create(); break;
            case 1:
            case 2: columns(); break;
            case 3: {
                const ft_status status = once_in(2) ? ft_tip_reset(some_tip()) : ft_tip_start_anew(some_tip());
                if (status > FT_NULL) fail("ft_tip_reset", "failed");
                break;
            }
            default:
                if (once_in(5)) hand_calls();
                else if (once_in(12)) rest();
                else if (once_in(12)) fuse();
                else sense();
        }
    }
    for (int i = 0; i < HELD; ++i) {
        ft_tip_free(&tips[i]);
        ft_hand_free(&hands[i]);
    }
    printf("%ld calls, %ld contacts, %ld samples without one, %ld with an array, nothing found\n", calls, contacts, others, fused);
    /* Else the calls have tried nothing. */
    if (calls >= 10000 && (contacts < calls / 20 || others < calls / 20)) fail("hostile", "too few contacts, or too many");
    if (calls >= 10000 && fused < calls / 1000) fail("hostile", "too few contacts with an array");
    return 0;
}
