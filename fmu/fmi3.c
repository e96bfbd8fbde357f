/* SPDX-License-Identifier: 0BSD */
/* The functions of FMI 3.0 [FmiThree2024]. Each calls one of instance.h. */
#include "instance.h"

#include "fmi/fmi3Functions.h"

static void log_sentence(fmu_function *callback, void *environment,
                         const char *name, fmu_status status, const char *text)
{
    fmi3LogMessageCallback log = (fmi3LogMessageCallback)callback;

    (void)name;
    log(environment, (fmi3Status)status, "logStatusError", text);
}

static fmi3Status settle(fmu_status status)
{
    return (fmi3Status)status;
}

static fmi3Status refuse(const fmu_instance *s, const char *sentence)
{
    return s ? settle(fmu_complain(s, "%s", sentence)) : fmi3Error;
}

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

/* Failures are always logged and nothing else is, so logging cannot be
   switched. */
fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn,
                               size_t nCategories,
                               const fmi3String categories[])
{
    (void)loggingOn;
    (void)nCategories;
    (void)categories;
    return instance ? fmi3OK : fmi3Error;
}

static fmu_callback callback_of(fmi3InstanceEnvironment environment,
                                fmi3LogMessageCallback log)
{
    return (fmu_callback){log_sentence, (fmu_function *)log, environment};
}

fmi3Instance fmi3InstantiateModelExchange(
    fmi3String instanceName, fmi3String instantiationToken,
    fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
    fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage)
{
    const fmu_request request = {
        .name = instanceName,
        .token = instantiationToken,
        .resources = resourcePath,
        .to = callback_of(instanceEnvironment, logMessage),
    };

    (void)visible;
    (void)loggingOn;
    return fmu_new(&request);
}

/* The number of parameters is the standard's. */
// NOLINTNEXTLINE(readability-function-size)
fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken,
    fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
    fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables,
    fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage,
    fmi3IntermediateUpdateCallback intermediateUpdate)
{
    const fmu_request request = {
        .name = instanceName,
        .token = instantiationToken,
        .resources = resourcePath,
        .steps_itself = true,
        .to = callback_of(instanceEnvironment, logMessage),
    };

    (void)visible;
    (void)loggingOn;
    (void)eventModeUsed;
    (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables;
    (void)nRequiredIntermediateVariables;
    (void)intermediateUpdate;
    return fmu_new(&request);
}

// NOLINTNEXTLINE(readability-function-size)
fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String instanceName, fmi3String instantiationToken,
    fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
    fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
    fmi3LockPreemptionCallback lockPreemption,
    fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)instanceName;
    (void)instantiationToken;
    (void)resourcePath;
    (void)visible;
    (void)loggingOn;
    (void)clockUpdate;
    (void)lockPreemption;
    (void)unlockPreemption;
    if (logMessage)
        logMessage(instanceEnvironment, fmi3Error, "logStatusError",
                   "it has no clocks to be scheduled by");
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance)
{
    fmu_free(instance);
}

static fmi3Status change_mode(fmu_instance *s, fmu_mode from, fmu_mode to,
                              const char *function)
{
    return settle(fmu_change_mode(s, from, to, function));
}

fmi3Status
fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined,
                            fmi3Float64 tolerance, fmi3Float64 startTime,
                            fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    (void)toleranceDefined;
    (void)tolerance;
    (void)stopTimeDefined;
    (void)stopTime;
    if (!instance || fmu_set_time(instance, startTime) != FMU_OK)
        return fmi3Error;
    return change_mode(instance, FMU_INSTANTIATED, FMU_INITIALISING,
                       "fmi3EnterInitializationMode");
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    return change_mode(instance, FMU_INITIALISING, FMU_RUNNING,
                       "fmi3ExitInitializationMode");
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    return change_mode(instance, FMU_RUNNING, FMU_TERMINATED, "fmi3Terminate");
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    return settle(instance ? fmu_reset(instance) : FMU_ERROR);
}

static fmi3Status check_count(const fmu_instance *s, size_t count,
                              size_t expected)
{
    if (count == expected)
        return fmi3OK;
    return settle(
        fmu_complain(s, "%zu values are given for %zu", count, expected));
}

fmi3Status fmi3GetFloat64(fmi3Instance instance,
                          const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float64 values[],
                          size_t nValues)
{
    if (!instance || check_count(instance, nValues, nValueReferences) != fmi3OK)
        return fmi3Error;
    return settle(fmu_get(instance, valueReferences, nValueReferences, values));
}

fmi3Status fmi3SetFloat64(fmi3Instance instance,
                          const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float64 values[],
                          size_t nValues)
{
    if (!instance || check_count(instance, nValues, nValueReferences) != fmi3OK)
        return fmi3Error;
    return settle(fmu_set(instance, valueReferences, nValueReferences, values));
}

/* ---- dependencies and derivatives --------------------------------------- */

fmi3Status
fmi3GetNumberOfVariableDependencies(fmi3Instance instance,
                                    fmi3ValueReference valueReference,
                                    size_t *nDependencies)
{
    return settle(instance ? fmu_dependencies(instance, valueReference, NULL,
                                              nDependencies)
                           : FMU_ERROR);
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance,
                                       fmi3ValueReference dependent,
                                       size_t elementIndicesOfDependent[],
                                       fmi3ValueReference independents[],
                                       size_t elementIndicesOfIndependents[],
                                       fmi3DependencyKind dependencyKinds[],
                                       size_t nDependencies)
{
    size_t count = 0;

    if (!instance ||
        fmu_dependencies(instance, dependent, NULL, &count) != FMU_OK ||
        check_count(instance, nDependencies, count) != fmi3OK)
        return fmi3Error;
    (void)fmu_dependencies(instance, dependent, independents, &count);
    for (size_t k = 0; k < count; k++) {
        elementIndicesOfDependent[k] = 0;
        elementIndicesOfIndependents[k] = 0;
        dependencyKinds[k] = fmi3Constant;
    }
    return fmi3OK;
}

static fmi3Status differentiate(const fmu_instance *s,
                                const fmu_partials *partials, bool adjoint,
                                const double *seed, double *out)
{
    return settle(fmu_differentiate(s, partials, adjoint, seed, out));
}

/* The number of parameters is the standard's. */
// NOLINTNEXTLINE(readability-function-size)
fmi3Status fmi3GetDirectionalDerivative(
    fmi3Instance instance, const fmi3ValueReference unknowns[],
    size_t nUnknowns, const fmi3ValueReference knowns[], size_t nKnowns,
    const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[],
    size_t nSensitivity)
{
    const fmu_partials partials = {unknowns, knowns, nUnknowns, nKnowns};

    if (!instance || check_count(instance, nSeed, nKnowns) != fmi3OK ||
        check_count(instance, nSensitivity, nUnknowns) != fmi3OK)
        return fmi3Error;
    return differentiate(instance, &partials, false, seed, sensitivity);
}

// NOLINTNEXTLINE(readability-function-size)
fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance,
                                    const fmi3ValueReference unknowns[],
                                    size_t nUnknowns,
                                    const fmi3ValueReference knowns[],
                                    size_t nKnowns, const fmi3Float64 seed[],
                                    size_t nSeed, fmi3Float64 sensitivity[],
                                    size_t nSensitivity)
{
    const fmu_partials partials = {unknowns, knowns, nUnknowns, nKnowns};

    if (!instance || check_count(instance, nSeed, nUnknowns) != fmi3OK ||
        check_count(instance, nSensitivity, nKnowns) != fmi3OK)
        return fmi3Error;
    return differentiate(instance, &partials, true, seed, sensitivity);
}

/* ---- states that an importer keeps --------------------------------------- */

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    return settle(fmu_state_get(instance, FMUState));
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState)
{
    return settle(fmu_state_set(instance, FMUState));
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    return settle(fmu_state_free(instance, FMUState));
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance,
                                      fmi3FMUState FMUState, size_t *size)
{
    return settle(fmu_state_size(instance, FMUState, size));
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState,
                                 fmi3Byte serializedState[], size_t size)
{
    return settle(
        fmu_state_serialize(instance, FMUState, serializedState, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance,
                                   const fmi3Byte serializedState[],
                                   size_t size, fmi3FMUState *FMUState)
{
    return settle(
        fmu_state_deserialize(instance, serializedState, size, FMUState));
}

/* ---- events, of which there are none ------------------------------------ */

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    return change_mode(instance, FMU_RUNNING, FMU_RUNNING,
                       "fmi3EnterEventMode");
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    return instance ? fmi3OK : fmi3Error;
}

fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
    fmi3Boolean *terminateSimulation,
    fmi3Boolean *nominalsOfContinuousStatesChanged,
    fmi3Boolean *valuesOfContinuousStatesChanged,
    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    *discreteStatesNeedUpdate = false;
    *terminateSimulation = false;
    *nominalsOfContinuousStatesChanged = false;
    *valuesOfContinuousStatesChanged = false;
    *nextEventTimeDefined = false;
    *nextEventTime = 0.0;
    return change_mode(instance, FMU_RUNNING, FMU_RUNNING,
                       "fmi3UpdateDiscreteStates");
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance,
                                          size_t *nEventIndicators)
{
    *nEventIndicators = 0;
    return instance ? fmi3OK : fmi3Error;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance,
                                  fmi3Float64 eventIndicators[],
                                  size_t nEventIndicators)
{
    (void)eventIndicators;
    return instance ? check_count(instance, nEventIndicators, 0) : fmi3Error;
}

/* ---- model exchange ----------------------------------------------------- */

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance)
{
    return settle(fmu_expect_exchange(instance, "fmi3EnterContinuousTimeMode"));
}

fmi3Status fmi3CompletedIntegratorStep(
    fmi3Instance instance, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
    fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    *enterEventMode = false;
    *terminateSimulation = false;
    return settle(fmu_expect_exchange(instance, "fmi3CompletedIntegratorStep"));
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time)
{
    if (fmu_expect_exchange(instance, "fmi3SetTime") != FMU_OK)
        return fmi3Error;
    return settle(fmu_set_time(instance, time));
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance,
                                   const fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    if (fmu_expect_exchange(instance, "fmi3SetContinuousStates") != FMU_OK)
        return fmi3Error;
    return settle(
        fmu_set_states(instance, continuousStates, nContinuousStates));
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance,
                                             fmi3Float64 derivatives[],
                                             size_t nContinuousStates)
{
    return settle(
        instance ? fmu_get_derivatives(instance, derivatives, nContinuousStates)
                 : FMU_ERROR);
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance,
                                   fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    return settle(
        instance ? fmu_get_states(instance, continuousStates, nContinuousStates)
                 : FMU_ERROR);
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance,
                                             fmi3Float64 nominals[],
                                             size_t nContinuousStates)
{
    return settle(instance
                      ? fmu_get_nominals(instance, nominals, nContinuousStates)
                      : FMU_ERROR);
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance,
                                           size_t *nContinuousStates)
{
    const fmu_instance *s = instance;

    *nContinuousStates = s ? s->model.num_states : 0;
    return s ? fmi3OK : fmi3Error;
}

/* ---- co-simulation ------------------------------------------------------ */

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    return change_mode(instance, FMU_RUNNING, FMU_RUNNING, "fmi3EnterStepMode");
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences,
                                    const fmi3Int32 orders[],
                                    fmi3Float64 values[], size_t nValues)
{
    (void)valueReferences;
    (void)orders;
    (void)values;
    (void)nValues;
    if (instance && nValueReferences == 0)
        return fmi3OK;
    return refuse(instance, "derivatives of outputs are not given");
}

// NOLINTNEXTLINE(readability-function-size)
fmi3Status fmi3DoStep(fmi3Instance instance,
                      fmi3Float64 currentCommunicationPoint,
                      fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                      fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation,
                      fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    fmu_instance *s = instance;
    fmu_status status = FMU_ERROR;

    (void)noSetFMUStatePriorToCurrentPoint;
    *eventHandlingNeeded = false;
    *terminateSimulation = false;
    *earlyReturn = false;
    *lastSuccessfulTime = currentCommunicationPoint;
    if (!s)
        return fmi3Error;
    status = fmu_do_step(s, currentCommunicationPoint, communicationStepSize);
    if (status == FMU_OK)
        *lastSuccessfulTime = s->time;
    return settle(status);
}
