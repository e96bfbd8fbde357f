/* SPDX-License-Identifier: 0BSD */
/*
 * The functions of FMI 3.0 [FmiThree2024] for types other than Float64, for
 * clocks and for structural parameters. The model has none of these, but an
 * importer looks for every function of the standard, so each is here and
 * refuses. Parameters that nothing reads have no names.
 */
#include "instance.h"

#include "fmi/fmi3Functions.h"

static fmi3Status refuse(const fmu_instance *s, const char *sentence)
{
    return s ? (fmi3Status)fmu_complain(s, "%s", sentence) : fmi3Error;
}

/* ---- variables of other types ------------------------------------------- */

/* A call that names no variable asks for nothing, and succeeds. */
static fmi3Status refuse_type(const fmu_instance *s, size_t count)
{
    if (s && count == 0)
        return fmi3OK;
    return refuse(s, "all variables are Float64");
}

/* A function that gets or sets `count` variables of a type. */
#define REFUSE_TYPE(FUNCTION, ...)                                             \
    fmi3Status FUNCTION(fmi3Instance instance, const fmi3ValueReference[],     \
                        size_t count, __VA_ARGS__)                             \
    {                                                                          \
        return refuse_type(instance, count);                                   \
    }

/* Both functions of a type whose values are one array. */
#define REFUSE_PAIR(TYPE)                                                      \
    REFUSE_TYPE(fmi3Get##TYPE, fmi3##TYPE[], size_t)                           \
    REFUSE_TYPE(fmi3Set##TYPE, const fmi3##TYPE[], size_t)

REFUSE_PAIR(Float32)
REFUSE_PAIR(Int8)
REFUSE_PAIR(UInt8)
REFUSE_PAIR(Int16)
REFUSE_PAIR(UInt16)
REFUSE_PAIR(Int32)
REFUSE_PAIR(UInt32)
REFUSE_PAIR(Int64)
REFUSE_PAIR(UInt64)
REFUSE_PAIR(Boolean)
REFUSE_PAIR(String)
REFUSE_TYPE(fmi3GetBinary, size_t[], fmi3Binary[], size_t)
REFUSE_TYPE(fmi3SetBinary, const size_t[], const fmi3Binary[], size_t)
REFUSE_TYPE(fmi3GetClock, fmi3Clock[])
REFUSE_TYPE(fmi3SetClock, const fmi3Clock[])

/* ---- clocks ------------------------------------------------------------- */

/* A function of some clocks, with its arguments behind their references. */
#define REFUSE_CLOCK(FUNCTION, ...)                                            \
    fmi3Status FUNCTION(fmi3Instance instance, const fmi3ValueReference[],     \
                        size_t, __VA_ARGS__)                                   \
    {                                                                          \
        return refuse(instance, "it has no clocks");                           \
    }

REFUSE_CLOCK(fmi3GetIntervalDecimal, fmi3Float64[], fmi3IntervalQualifier[])
REFUSE_CLOCK(fmi3GetIntervalFraction, fmi3UInt64[], fmi3UInt64[],
             fmi3IntervalQualifier[])
REFUSE_CLOCK(fmi3GetShiftDecimal, fmi3Float64[])
REFUSE_CLOCK(fmi3GetShiftFraction, fmi3UInt64[], fmi3UInt64[])
REFUSE_CLOCK(fmi3SetIntervalDecimal, const fmi3Float64[])
REFUSE_CLOCK(fmi3SetIntervalFraction, const fmi3UInt64[], const fmi3UInt64[])
REFUSE_CLOCK(fmi3SetShiftDecimal, const fmi3Float64[])
REFUSE_CLOCK(fmi3SetShiftFraction, const fmi3UInt64[], const fmi3UInt64[])

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference,
                                      fmi3Float64)
{
    return refuse(instance, "it has no clocks");
}

/* ---- structural parameters ---------------------------------------------- */

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance)
{
    return refuse(instance, "it has no structural parameters");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance)
{
    return refuse(instance, "it has no structural parameters");
}
