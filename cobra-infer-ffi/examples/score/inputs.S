/* The files that TEMPLATE, CROWDED and POINTS name, as they are, in read-only memory. */

    .section .rodata.inputs, "a"

.macro file name, path
    .global \name\()_start
    .global \name\()_end
\name\()_start:
    .incbin "\path"
\name\()_end:
.endm

    file template, TEMPLATE
    file crowded, CROWDED
    file points, POINTS

#ifdef __linux__
    .section .note.GNU-stack, "", %progbits
#endif
