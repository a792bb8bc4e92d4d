/*
 * What runs before main on an MPS2 AN386 as QEMU models it (Cortex-M4F), and how it speaks to the emulator. For another
 * board take its own startup file.
 */
#include "board.h"

extern uint32_t stack_top[], data_start[], data_end[], data_load[], bss_start[], bss_end[];
int main(void);
void reset(void);
static void fault(void);

/* Where the core begins, and where it goes when something is wrong. */
struct vectors {
    uint32_t *stack;
    void (*entries[15])(void);
};
__attribute__((section(".vectors"), used)) static const struct vectors vectors = {
    stack_top, {reset, fault, fault, fault, fault, fault},
};

/* Semihosting: an operation and its argument. */
static int ask(int operation, const void *argument) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void say(const char *text) { (void)ask(0x04, text); }

void leave(int failed) {
    for (;;) (void)ask(0x18, (const void *)(failed ? 0x20023u : 0x20026u));
}

static void fault(void) {
    say("a fault\n");
    leave(1);
}

void reset(void) {
    /* The floating-point unit, before anything uses it. */
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm__ volatile("dsb\n isb");
    for (uint32_t *to = data_start, *from = data_load; to < data_end;) *to++ = *from++;
    for (uint32_t *to = bss_start; to < bss_end;) *to++ = 0;
    leave(main());
}

/* SysTick counts down with each instruction: QEMU lets a fixed time pass with it (-icount). */
#define SYST ((volatile uint32_t *)0xE000E010u)
enum { PERIOD = 0x00FFFFFF };
static uint32_t reading, ticks_per_thousand;

uint32_t counter_now(void) { return SYST[2]; }

static __attribute__((noinline)) uint32_t loop_ticks(uint32_t turns) {
    const uint32_t start = counter_now();
    __asm__ volatile("1: subs %0, #1\n bne 1b" : "+r"(turns) : : "cc");
    return (start - counter_now()) & PERIOD;
}

void counter_begin(void) {
    SYST[1] = PERIOD;
    SYST[2] = 0;
    SYST[0] = 5; /* The core's clock, counting. */
    ticks_per_thousand = (loop_ticks(10500) - loop_ticks(500)) / 20;
    const uint32_t start = counter_now();
    reading = (start - counter_now()) & PERIOD;
}

uint32_t counter_instructions(uint32_t start, uint32_t end) {
    uint32_t ticks = (start - end) & PERIOD;
    ticks = ticks > reading ? ticks - reading : 0;
    return (ticks * 1000u + ticks_per_thousand / 2) / ticks_per_thousand;
}

/* The stack below here is painted, and later looked at. */
enum { DEPTH = 16 * 1024, MARGIN = 64, PAINT = 0x5EADBEEF };

__attribute__((noinline)) void stack_paint(void) {
    uint32_t top;
    __asm__ volatile("mov %0, sp" : "=r"(top));
    for (uint32_t at = (top & ~3u) - DEPTH; at < (top & ~3u) - MARGIN; at += 4) *(volatile uint32_t *)at = PAINT;
}

__attribute__((noinline)) uint32_t stack_used(void) {
    uint32_t top;
    __asm__ volatile("mov %0, sp" : "=r"(top));
    uint32_t at = (top & ~3u) - DEPTH + 256;
    while (at < (top & ~3u) && *(volatile uint32_t *)at == PAINT) at += 4;
    return (top & ~3u) - at;
}

/* A heap that gives and never takes back: for the shapes that need one, once. */
void *malloc(uint32_t bytes);
void free(void *memory);
void *malloc(uint32_t bytes) {
    static uint64_t heap[6 * 1024];
    static uint32_t used;
    const uint32_t words = (bytes + 7u) / 8u;
    if (words > sizeof heap / sizeof *heap - used) return 0;
    used += words;
    return &heap[used - words];
}
void free(void *memory) { (void)memory; }
