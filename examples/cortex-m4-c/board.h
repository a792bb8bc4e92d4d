/* What play.c asks of where it runs: start.c has it for the board, host.c for a computer. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Prints a text. */
void say(const char *text);
/* Ends the program. */
void leave(int failed);
/* Counts instructions; a computer counts none. */
void counter_begin(void);
uint32_t counter_now(void);
uint32_t counter_instructions(uint32_t start, uint32_t end);
/* How many bytes of stack were used since it was painted; a computer does not know. */
void stack_paint(void);
uint32_t stack_used(void);

#endif
