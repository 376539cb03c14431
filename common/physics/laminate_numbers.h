/* What is known of the border in an element that is a laminate of two volumes (element_laminate.h), as numbers: the
 * normal, the second part's moments, the kink's hourglass modes, the moments of both parts together. Owns nothing.
 */
#ifndef SINEW_LAMINATE_NUMBERS_H
#define SINEW_LAMINATE_NUMBERS_H

enum { LAMINATE_NORMAL = 0, LAMINATE_SECOND = 3, LAMINATE_KINK = 9, LAMINATE_WHOLE = 13, LAMINATE_NUMBERS = 19 };

#endif
