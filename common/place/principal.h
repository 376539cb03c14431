/* The principal axes of points: eigenvectors of a symmetric matrix of 3 x 3, by Jacobi rotations. Keeps nothing.
 */
#ifndef SINEW_PRINCIPAL_H
#define SINEW_PRINCIPAL_H

/* c: symmetric; its diagonal becomes its eigenvalues. v: column i is the unit eigenvector of c[i][i]. They are in no
 * order. */
void principal_axes(double c[3][3], double v[3][3]);

/* The column of the largest of the three, or of the smallest. Of equal ones the first. */
int principal_largest(double c[3][3]);
int principal_smallest(double c[3][3]);

#endif
