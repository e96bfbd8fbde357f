/* References to models of any kind. */
#include <ritz/model.h>

ritz_model ritz_model_of_component(const ritz_component *component,
                                   const ritz_damping *damping)
{
    return (ritz_model){.kind = RITZ_MODEL_COMPONENT,
                        .component = component,
                        .dampers = &component->dampers,
                        .damping = damping};
}

ritz_model ritz_model_of_dense(const ritz_second_order *matrices,
                               const ritz_damping *damping)
{
    return (ritz_model){
        .kind = RITZ_MODEL_DENSE, .dense = *matrices, .damping = damping};
}

ritz_model ritz_model_of_reduced(const ritz_reduced *reduced,
                                 const ritz_damping *damping)
{
    const ritz_reduced *r = reduced;

    return (ritz_model){.kind = RITZ_MODEL_DENSE,
                        .dense = {&r->K, &r->M, &r->D, &r->K4, &r->io},
                        .reduced = reduced,
                        .dampers = &r->dampers,
                        .damping = damping};
}

ritz_model ritz_model_of_configuration(const ritz_configuration *configuration,
                                       const ritz_damping *damping)
{
    const ritz_configuration *c = configuration;

    return (ritz_model){.kind = RITZ_MODEL_DENSE,
                        .dense = {&c->K, &c->M, &c->D, &c->K4, &c->io},
                        .dampers = &c->dampers,
                        .damping = damping};
}

ritz_model ritz_model_of_states(const ritz_state_space *states)
{
    return (ritz_model){.kind = RITZ_MODEL_STATES, .states = states};
}

int64_t ritz_state_space_order(const ritz_state_space *model)
{
    return model->sA.colptr ? model->sA.nrow : model->A.nrow;
}

bool ritz_state_space_is_sparse(const ritz_state_space *model)
{
    return model->sA.colptr != NULL;
}

int64_t ritz_model_order(ritz_model model)
{
    switch (model.kind) {
    case RITZ_MODEL_COMPONENT:
        return model.component->num_dofs;
    case RITZ_MODEL_DENSE:
        return model.dense.K->nrow;
    case RITZ_MODEL_STATES:
        break;
    }
    return ritz_state_space_order(model.states);
}

ritz_io ritz_model_io(ritz_model model)
{
    const ritz_state_space *s = model.states;

    switch (model.kind) {
    case RITZ_MODEL_COMPONENT:
        return model.component->io;
    case RITZ_MODEL_DENSE:
        return *model.dense.io;
    case RITZ_MODEL_STATES:
        break;
    }
    return (ritz_io){.num_inputs = s->num_inputs,
                     .num_outputs = s->num_outputs,
                     .input = s->input,
                     .output = s->output,
                     .limit = s->limit};
}
