/* From the film to a file: exposure, tone curve, encoding. */
#ifndef RD_PICTURE_H
#define RD_PICTURE_H

#include "report.h"
#include "view.h"

/* Writes .exr (the film as it is) or .png. `exposure` scales lit values before the tone curve. */
bool rd_picture_write(const char* path, int width, int height, const float* film,
                      rd_encoding encoding, float exposure, rd_report* report);

#endif
