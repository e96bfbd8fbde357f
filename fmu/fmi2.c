/* SPDX-License-Identifier: 0BSD */
/* The functions of FMI 2.0 [FmiTwo2024]. Each calls one of instance.h. */
#include "instance.h"

#include "fmi/fmi2Functions.h"

static void log_sentence(fmu_function *callback, void *environment,
                         const char *name, fmu_status status, const char *text)
{
    fmi2CallbackLogger logger = (fmi2CallbackLogger)callback;

    logger(environment, name, (fmi2Status)status, "logStatusError", "%s", text);
}

static fmi2Status settle(fmu_status status)
{
    return (fmi2Status)status;
}

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

/* Failures are always logged and nothing else is, so logging cannot be
   switched. */
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn,
                               size_t nCategories,
                               const fmi2String categories[])
{
    (void)loggingOn;
    (void)nCategories;
    (void)categories;
    return c ? fmi2OK : fmi2Error;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType,
                              fmi2String fmuGUID,
                              fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    fmu_request request = {
        .name = instanceName,
        .token = fmuGUID,
        .resources = fmuResourceLocation,
        .is_uri = true,
        .steps_itself = fmuType == fmi2CoSimulation,
    };

    (void)visible;
    (void)loggingOn;
    if (functions && functions->logger)
        request.to =
            (fmu_callback){log_sentence, (fmu_function *)functions->logger,
                           functions->componentEnvironment};
    return fmu_new(&request);
}

void fmi2FreeInstance(fmi2Component c)
{
    fmu_free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined,
                               fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    (void)toleranceDefined;
    (void)tolerance;
    (void)stopTimeDefined;
    (void)stopTime;
    if (!c || fmu_expect(c, FMU_INSTANTIATED, "fmi2SetupExperiment") != FMU_OK)
        return fmi2Error;
    return settle(fmu_set_time(c, startTime));
}

static fmi2Status change_mode(fmu_instance *s, fmu_mode from, fmu_mode to,
                              const char *function)
{
    return settle(fmu_change_mode(s, from, to, function));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return change_mode(c, FMU_INSTANTIATED, FMU_INITIALISING,
                       "fmi2EnterInitializationMode");
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return change_mode(c, FMU_INITIALISING, FMU_RUNNING,
                       "fmi2ExitInitializationMode");
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    return change_mode(c, FMU_RUNNING, FMU_TERMINATED, "fmi2Terminate");
}

fmi2Status fmi2Reset(fmi2Component c)
{
    return settle(c ? fmu_reset(c) : FMU_ERROR);
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[],
                       size_t nvr, fmi2Real value[])
{
    return settle(c ? fmu_get(c, vr, nvr, value) : FMU_ERROR);
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[],
                       size_t nvr, const fmi2Real value[])
{
    return settle(c ? fmu_set(c, vr, nvr, value) : FMU_ERROR);
}

/* ---- variables of other types, which there are not ---------------------- */

/* A call that names no variable asks for nothing, and succeeds. */
static fmi2Status refuse_type(const fmu_instance *s, size_t count)
{
    if (s && count == 0)
        return fmi2OK;
    return s ? settle(fmu_complain(s, "all variables are real")) : fmi2Error;
}

/* Both functions of a type; parameters that nothing reads have no names. */
#define REFUSE_PAIR(TYPE)                                                      \
    fmi2Status fmi2Get##TYPE(fmi2Component c, const fmi2ValueReference[],      \
                             size_t count, fmi2##TYPE[])                       \
    {                                                                          \
        return refuse_type(c, count);                                          \
    }                                                                          \
    fmi2Status fmi2Set##TYPE(fmi2Component c, const fmi2ValueReference[],      \
                             size_t count, const fmi2##TYPE[])                 \
    {                                                                          \
        return refuse_type(c, count);                                          \
    }

REFUSE_PAIR(Integer)
REFUSE_PAIR(Boolean)
REFUSE_PAIR(String)

/* ---- states that an importer keeps --------------------------------------- */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    return settle(fmu_state_get(c, FMUstate));
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    return settle(fmu_state_set(c, FMUstate));
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    return settle(fmu_state_free(c, FMUstate));
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate,
                                      size_t *size)
{
    return settle(fmu_state_size(c, FMUstate, size));
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate,
                                 fmi2Byte serializedState[], size_t size)
{
    return settle(fmu_state_serialize(c, FMUstate,
                                      (unsigned char *)serializedState, size));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c,
                                   const fmi2Byte serializedState[],
                                   size_t size, fmi2FMUstate *FMUstate)
{
    return settle(fmu_state_deserialize(
        c, (const unsigned char *)serializedState, size, FMUstate));
}

/* ---- derivatives -------------------------------------------------------- */

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c,
                                        const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown,
                                        const fmi2ValueReference vKnown_ref[],
                                        size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[])
{
    const fmu_partials partials = {vUnknown_ref, vKnown_ref, nUnknown, nKnown};

    return settle(c ? fmu_differentiate(c, &partials, false, dvKnown, dvUnknown)
                    : FMU_ERROR);
}

/* ---- model exchange ----------------------------------------------------- */

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    return settle(fmu_expect_exchange(c, "fmi2EnterEventMode"));
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *fmi2eventInfo)
{
    *fmi2eventInfo = (fmi2EventInfo){0};
    return settle(fmu_expect_exchange(c, "fmi2NewDiscreteStates"));
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    return settle(fmu_expect_exchange(c, "fmi2EnterContinuousTimeMode"));
}

fmi2Status fmi2CompletedIntegratorStep(
    fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
    fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    *enterEventMode = fmi2False;
    *terminateSimulation = fmi2False;
    return settle(fmu_expect_exchange(c, "fmi2CompletedIntegratorStep"));
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    if (fmu_expect_exchange(c, "fmi2SetTime") != FMU_OK)
        return fmi2Error;
    return settle(fmu_set_time(c, time));
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[],
                                   size_t nx)
{
    if (fmu_expect_exchange(c, "fmi2SetContinuousStates") != FMU_OK)
        return fmi2Error;
    return settle(fmu_set_states(c, x, nx));
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[],
                              size_t nx)
{
    return settle(c ? fmu_get_derivatives(c, derivatives, nx) : FMU_ERROR);
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[],
                                  size_t ni)
{
    (void)eventIndicators;
    if (c && ni == 0)
        return fmi2OK;
    return c ? settle(fmu_complain(c, "there are no events")) : fmi2Error;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    return settle(c ? fmu_get_states(c, x, nx) : FMU_ERROR);
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c,
                                             fmi2Real x_nominal[], size_t nx)
{
    return settle(c ? fmu_get_nominals(c, x_nominal, nx) : FMU_ERROR);
}

/* ---- co-simulation ------------------------------------------------------ */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c,
                                       const fmi2ValueReference vr[],
                                       size_t nvr, const fmi2Integer order[],
                                       const fmi2Real value[])
{
    (void)vr;
    (void)order;
    (void)value;
    if (c && nvr == 0)
        return fmi2OK;
    return c ? settle(fmu_complain(c, "inputs are held over a step: they have "
                                      "no derivatives"))
             : fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c,
                                        const fmi2ValueReference vr[],
                                        size_t nvr, const fmi2Integer order[],
                                        fmi2Real value[])
{
    (void)vr;
    (void)order;
    (void)value;
    if (c && nvr == 0)
        return fmi2OK;
    return c ? settle(fmu_complain(c, "derivatives of outputs are not given"))
             : fmi2Error;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    return settle(
        c ? fmu_do_step(c, currentCommunicationPoint, communicationStepSize)
          : FMU_ERROR);
}

/* Steps are complete when fmi2DoStep returns. */
static fmi2Status refuse_pending(const fmu_instance *s)
{
    return s ? settle(fmu_complain(s, "no step is pending")) : fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return refuse_pending(c);
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s,
                         fmi2Status *value)
{
    (void)s;
    (void)value;
    return refuse_pending(c);
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s,
                             fmi2Real *value)
{
    const fmu_instance *instance = c;

    if (!c || s != fmi2LastSuccessfulTime)
        return refuse_pending(c);
    *value = instance->time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s,
                                fmi2Integer *value)
{
    (void)s;
    (void)value;
    return refuse_pending(c);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s,
                                fmi2Boolean *value)
{
    if (!c || s != fmi2Terminated)
        return refuse_pending(c);
    *value = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s,
                               fmi2String *value)
{
    (void)s;
    (void)value;
    return refuse_pending(c);
}
