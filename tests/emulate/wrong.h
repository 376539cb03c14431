/* Kernels that are wrong, each in one way, and what the emulated card has to say of it: wrong.cu.
 */
#ifndef SINEW_WRONG_H
#define SINEW_WRONG_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wrong_kernel {
    const char *name, *says; /* says: part of the fault's text; NULL: it is right */
    int (*start)(void);      /* a cudaError_t */
} wrong_kernel;

/* Ends with one of no name. */
extern const wrong_kernel wrong_kernels[];

/* Of what a launch returned. */
const char *wrong_text(int error);

#ifdef __cplusplus
}
#endif

#endif
