/* Start-up of a Cortex-M4F: the FPU, the sections, the semihosting that printf goes through. */

#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];

int main(void);
void initialise_monitor_handles(void);
void reset(void);

static void fault(void)
{
    _exit(2);
}

/* Only what the example can meet: reset and the faults. */
__attribute__((section(".vectors"), used)) static const struct {
    const void *stack;
    void (*handlers[15])(void);
} vectors = {stack_top, {reset, fault, fault, fault, fault, fault}};

static void run(void)
{
    int status;

    memcpy(data_start, data_load, (size_t)((char *)data_end - (char *)data_start));
    memset(bss_start, 0, (size_t)((char *)bss_end - (char *)bss_start));
    initialise_monitor_handles();
    status = main();
    fflush(stdout);
    _exit(status);
}

/* Alone, because the compiler may use the FPU in whatever comes behind. */
__attribute__((naked)) void reset(void)
{
    __asm__ volatile("ldr r0, =0xe000ed88\n" /* CPACR: full access to CP10 and CP11 */
                     "ldr r1, [r0]\n"
                     "orr r1, r1, #0xf00000\n"
                     "str r1, [r0]\n"
                     "dsb\n"
                     "isb\n"
                     "b %c0\n"
                     :
                     : "i"(run));
}
