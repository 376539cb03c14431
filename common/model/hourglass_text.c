#include "model/hourglass_text.h"

#include "base/num.h"

#include <stdio.h>
#include <string.h>

int hourglass_read(const char *text, hourglass_control *to)
{
    static const char isotropic[] = "isotropic";
    const size_t size = sizeof isotropic - 1;
    *to = (hourglass_control){HOURGLASS_PHYSICAL, 0};
    if (!strcmp(text, "physical"))
        return 0;
    *to = (hourglass_control){HOURGLASS_ISOTROPIC, HOURGLASS_USUAL_KAPPA};
    if (!strcmp(text, isotropic))
        return 0;
    if (!strncmp(text, isotropic, size) && text[size] == ':')
        text += size + 1;
    return num_double(text, &to->kappa) || !(to->kappa >= 0 && to->kappa <= 1e3) ? -1 : 0;
}

void hourglass_text(hourglass_control control, char text[HOURGLASS_TEXT])
{
    char kappa[NUM_TEXT];
    num_text(control.kappa, false, kappa);
    if (control.kind == HOURGLASS_PHYSICAL)
        snprintf(text, HOURGLASS_TEXT, "physical");
    else
        snprintf(text, HOURGLASS_TEXT, "isotropic:%s", kappa);
}
