/* Transparency without sorting: what both backends know of the modes of hdrp_oit.h. */
#ifndef RD_OIT_H
#define RD_OIT_H

#include "hdrp_oit.h"
#include "options.h"

/* Of anything but RD_OIT_SORTED. */
hdrp_oit_mode rd_oit_mode(rd_oit oit);

/* What light [nits] is multiplied by, so that colours are near 1: the power of 2 that is nearest to
 * the exposure, so that nothing is rounded. */
float rd_oit_unit(float exposure);

#endif
