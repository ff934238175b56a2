/* The files that TEMPLATE, CROWDED, POINTS, SCENE and IMAGE name, as they are, in read-only memory; words of
   the image are to be aligned. */

    .section .rodata.inputs, "a"

.macro file name, path
    .balign 4
    .global \name\()_start
    .global \name\()_end
\name\()_start:
    .incbin "\path"
\name\()_end:
.endm

    file template, TEMPLATE
    file crowded, CROWDED
    file points, POINTS
    file scene, SCENE
    file image, IMAGE

#ifdef __linux__
    .section .note.GNU-stack, "", %progbits
#endif
