/*
 * Plays the session of session.h through an exported scene: prints a number for all bits of every answer, and what a
 * sample costs. Each answer is compared with that of the scene itself, as `fingertip export` worked it out in Rust: bit for
 * bit, or, where session.h says how near they shall be, point and normal to that.
 */
#include "board.h"
#include "session.h"
#include "tip.h"

/* In static memory: a controller has no heap. */
static tip_state state, again;
static tip_touch touch;
static uint32_t counts[TIP_SAMPLES];

static void say_number(uint32_t number) {
    char text[11], *at = text + 10;
    *at = '\0';
    do {
        *--at = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    say(at);
}

/* FNV-1a over the words of an answer: its fields have no room between them. */
static uint32_t fold(const tip_touch *answer) {
    const unsigned char *byte = (const unsigned char *)answer;
    uint32_t sum = 0x811C9DC5u;
    for (uint32_t i = 0; i < sizeof *answer; i += 4) {
        const uint32_t word = (uint32_t)byte[i] | (uint32_t)byte[i + 1] << 8 | (uint32_t)byte[i + 2] << 16 |
                              (uint32_t)byte[i + 3] << 24;
        sum = (sum ^ word) * 0x01000193u;
    }
    return sum;
}

#ifdef TIP_NEAR
/* The largest part by which two vectors differ, or a number beyond every tolerance. */
static float apart(const float *one, const float *other) {
    float largest = 0.0f;
    for (uint32_t i = 0; i < 3; ++i) {
        const float part = one[i] > other[i] ? one[i] - other[i] : other[i] - one[i];
        if (!(part <= 1.0f)) return 2.0f;
        if (part > largest) largest = part;
    }
    return largest;
}
#endif

static uint32_t sense(tip_state *tip, uint32_t sample) {
#ifdef TIP_TAKES_CELSIUS
    return tip_sense(tip, tip_session[sample], tip_celsius, tip_step, &touch);
#else
    return tip_sense(tip, tip_session[sample], tip_step, &touch);
#endif
}

static uint32_t begin(tip_state *tip) {
#ifdef TIP_TAKES_ZERO
    return tip_init(tip, 0);
#else
    return tip_init(tip);
#endif
}

/* From the smallest to the largest. */
static void sort(uint32_t *numbers, uint32_t count) {
    for (uint32_t i = 1; i < count; ++i) {
        const uint32_t number = numbers[i];
        uint32_t at = i;
        for (; at > 0 && numbers[at - 1] > number; --at) numbers[at] = numbers[at - 1];
        numbers[at] = number;
    }
}

/* A call without its work. */
static __attribute__((noinline)) uint32_t nothing(tip_state *tip, uint32_t sample) {
    __asm__ volatile("" : : "r"(tip), "r"(sample) : "memory");
    return 0;
}

int main(void) {
    if (begin(&state) != 0 || begin(&again) != 0) {
        say("the fingertip cannot be begun\n");
        return 1;
    }
    counter_begin();
    uint32_t start = counter_now();
    (void)nothing(&state, 0);
    const uint32_t call = counter_instructions(start, counter_now());
    uint32_t different = 0, contacts = 0;
#ifdef TIP_NEAR
    uint32_t equal = 0;
    float far = 0.0f, turned = 0.0f;
#endif
    for (uint32_t sample = 0; sample < TIP_SAMPLES; ++sample) {
        start = counter_now();
        const uint32_t resolution = sense(&state, sample);
        const uint32_t count = counter_instructions(start, counter_now());
        counts[sample] = count > call ? count - call : 0;
        const uint32_t sum = fold(&touch);
        say("bits ");
        say_number(sample);
        say(" ");
        say_number(sum);
        say("\n");
#ifdef TIP_NEAR
        const float off = apart(touch.point, tip_expected_point[sample]);
        const float turn = apart(touch.normal, tip_expected_normal[sample]);
        different += resolution != tip_expected_resolution[sample] || !(off <= TIP_NEAR) || !(turn <= TIP_NEAR_NORMAL);
        if (off > far) far = off;
        if (turn > turned) turned = turn;
        equal += sum == tip_expected[sample];
#else
        different += sum != tip_expected[sample];
#endif
        contacts += resolution == 0;
    }
    stack_paint();
    for (uint32_t sample = 0; sample < TIP_SAMPLES; ++sample) (void)sense(&again, sample);
    const uint32_t stack = stack_used();
    sort(counts, TIP_SAMPLES);
    const uint32_t numbers[6] = {TIP_SAMPLES, contacts, different, counts[TIP_SAMPLES / 2], counts[TIP_SAMPLES - 1], stack};
    say("cost");
    for (uint32_t i = 0; i < 6; ++i) {
        say(" ");
        say_number(numbers[i]);
    }
    say("\n");
#ifdef TIP_NEAR
    /* Equal answers, nanometres, millionths. */
    say("near ");
    say_number(equal);
    say(" ");
    say_number((uint32_t)(far * 1e9f));
    say(" ");
    say_number((uint32_t)(turned * 1e6f));
    say("\n");
#endif
    return 0;
}
