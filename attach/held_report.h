/* Prints the report of attach --report: a table of the rigid surfaces, the faces that hold no node, and a table of the
 * muscles with their attachments. Keeps nothing.
 */
#ifndef SINEW_HELD_REPORT_H
#define SINEW_HELD_REPORT_H

#include "cli/tool.h"
#include "muscle.h"
#include "rigid.h"

int held_report_surfaces(const tool *t, const rigid *r, err *e);
int held_report_muscles(const tool *t, const muscles *list, const rigid *r, err *e);

#endif
