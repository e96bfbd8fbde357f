/* All of Ritz: link with -lritz, or ask pkg-config for ritz. */
#ifndef RITZ_RITZ_H
#define RITZ_RITZ_H

#include <ritz/assembly.h>
#include <ritz/base.h>
#include <ritz/basis.h>
#include <ritz/check.h>
#include <ritz/component.h>
#include <ritz/constrained.h>
#include <ritz/container.h>
#include <ritz/controlled.h>
#include <ritz/export.h>
#include <ritz/fit.h>
#include <ritz/import.h>
#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/parts.h>
#include <ritz/poles.h>
#include <ritz/ranking.h>
#include <ritz/recover.h>
#include <ritz/reduced.h>
#include <ritz/response.h>
#include <ritz/scene.h>
#include <ritz/simulate.h>
#include <ritz/spin.h>
#include <ritz/state_space.h>
#include <ritz/subspace.h>
#include <ritz/swept.h>
#include <ritz/switched.h>
#include <ritz/system.h>
#include <ritz/tuning.h>
#include <ritz/verify.h>

#endif
