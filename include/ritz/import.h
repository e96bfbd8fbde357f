/*
 * Matrices in foreign files: NASTRAN OUTPUT4, DMIG and punch, Matrix Market,
 * MAT, and coordinates, MATRIX INPUT and USER ELEMENT of Abaqus and CalculiX. A
 * format is recognised by content, never by name. MAT 7.3 files are HDF5 files,
 * which ritz_container_guard protects against.
 */
#ifndef RITZ_IMPORT_H
#define RITZ_IMPORT_H

#include <ritz/base.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#pragma GCC visibility push(default)

/* One matrix as its file states it; both triangles once read. */
typedef struct ritz_matrix {
    char name[RITZ_NAME_SIZE]; /* "KGG"; "" where the format has none */
    ritz_sparse A;
    double *imaginary; /* of each entry of A; NULL if real */
    bool symmetric;    /* the file says so */
    int64_t digits;    /* significant decimal digits of its values: 17 binary
                          double, 7 binary single, else as written */
    char spelling[RITZ_NAME_SIZE]; /* "OUTPUT4 text, bigmat, 1P,3E23.16" */
    ritz_dof *row; /* dof of each row where the file says; else NULL */
    ritz_dof *col; /* of each column, of rectangular ones; NULL: as rows */
    char other[RITZ_NAME_SIZE]; /* why it is no matrix that can be used, "a cell
                                   array"; A is then 0 x 0. "": it is one */
} ritz_matrix;

typedef struct ritz_matrices {
    int64_t count;
    ritz_matrix *matrix;
} ritz_matrices;

/* An entry of the directory: a matrix whose values were not read. */
typedef struct ritz_listed {
    char name[RITZ_NAME_SIZE];
    int64_t nrow, ncol; /* as its header has them; -1: only reading tells */
    bool symmetric, is_complex;
    int64_t at;   /* where it begins: byte of the file, or place among others */
    int64_t line; /* of that byte, where the format is text */
    char other[RITZ_NAME_SIZE]; /* as in ritz_matrix */
    struct ritz_marks *marks;   /* places in a large matrix from which several
                                   threads read on; NULL: there are none */
} ritz_listed;

typedef struct ritz_listing {
    int64_t count, room;
    ritz_listed *item;
} ritz_listing;

/* A file of matrices that was read, and the directory of what it holds. */
typedef struct ritz_foreign {
    char *path;        /* NULL: bytes without a file */
    const char *bytes; /* a NUL follows those of a file */
    int64_t size;
    char *folder; /* where files that it includes lie; NULL: none is followed */
    char digest[RITZ_DIGEST_SIZE];    /* SHA-256 of the bytes; empty until
                                      ritz_foreign_digest() is called */
    struct ritz_digest_work *summing; /* its computation, until then */
    const struct ritz_format *format; /* NULL: none knows it */
    ritz_listing listing;
    char *owned;                /* the bytes of a file that was copied */
    struct ritz_mapped *mapped; /* or those of a file that is mapped */
} ritz_foreign;

typedef struct ritz_format {
    const char *name;      /* "output4" */
    const char *summary;   /* one line */
    const char *reference; /* key in docs/references.bib */
    /** True if these bytes look like the format. @p size may be 0. */
    bool (*recognise)(const char *bytes, int64_t size);
    /** Called once before anything is read, by formats that another library
     * parses: whether that library may have these bytes (ritz_container_guard).
     * NULL: no other library gets them. */
    ritz_status (*admit)(const char *bytes, int64_t size);
    /** Whether a large file may be mapped: list() and read() rely neither on a
     * NUL behind the bytes nor on bytes being the same when read again. */
    bool maps;
    /**
     * Append what the file holds, without its values where the format allows
     * that. @return RITZ_ERR_FORMAT naming line or byte
     */
    ritz_status (*list)(const ritz_foreign *file, ritz_listing *out);
    /** Read one matrix of the list. @return as list */
    ritz_status (*read)(const ritz_foreign *file, const ritz_listed *which,
                        ritz_matrix *out);
} ritz_format;

/** All formats of matrices, ended by NULL. */
extern const ritz_format *const ritz_formats[];
extern const ritz_format ritz_format_coordinates;
extern const ritz_format ritz_format_dmig;
extern const ritz_format ritz_format_harwell_boeing;
extern const ritz_format ritz_format_mat;
extern const ritz_format ritz_format_matrix_input;
extern const ritz_format ritz_format_matrix_market;
extern const ritz_format ritz_format_output4;
extern const ritz_format ritz_format_user_element;

/* A file format of another program that is recognised but not read. */
typedef struct ritz_unread {
    const char *name;   /* "a binary file of ANSYS" */
    const char *advice; /* how to convert it to a format that is read */
    /** True if these bytes look like the format. @p size may be 0. */
    bool (*recognise)(const char *bytes, int64_t size);
} ritz_unread;

/** All formats that are recognised but not read, ended by a row without a
 * name. */
extern const ritz_unread ritz_unread_formats[];

/** The format of that table which these bytes look like; NULL: none. */
const ritz_unread *ritz_unread_find(const char *bytes, int64_t size);

/** @return RITZ_ERR_FORMAT if the bytes look like one of these formats; the
 *         message names it */
ritz_status ritz_unread_refuse(const char *bytes, int64_t size);

/**
 * Read a file into memory, or map it, and recognise its format by content.
 * Another thread
 * starts to compute the SHA-256 of a file of 4 MiB or more if
 * ritz_set_threads() allows two; a smaller file's is computed at once.
 *
 * @param[out] out  format NULL if none knows the file; freed by
 *                  ritz_foreign_free()
 * @return RITZ_ERR_FILE if the file cannot be read
 */
ritz_status ritz_foreign_open(const char *path, ritz_foreign *out);

/** SHA-256 of the file's bytes as 64 hexadecimal digits, which @p file keeps.
 * Waits until they are computed. */
const char *ritz_foreign_digest(ritz_foreign *file);

/** Fill the directory; @return RITZ_ERR_FORMAT if no format knows the file,
 * RITZ_ERR_FILE if it was mapped and was changed since. */
ritz_status ritz_foreign_list(ritz_foreign *file);

/** Read matrix @p k of the directory. @return as ritz_foreign_list() */
ritz_status ritz_foreign_take(const ritz_foreign *file, int64_t k,
                              ritz_matrix *out);

/** Put the path of a file before the sentence of a failure. */
ritz_status ritz_foreign_context(const ritz_foreign *file, ritz_status status);
void ritz_foreign_free(ritz_foreign *file);

/* Files that were read, and their SHA-256. */
typedef struct ritz_file_sum {
    char *path;
    char digest[RITZ_DIGEST_SIZE];
} ritz_file_sum;

typedef struct ritz_file_sums {
    int64_t count, room;
    ritz_file_sum *sum;
} ritz_file_sums;

/** Append a file. */
ritz_status ritz_file_sums_add(ritz_file_sums *sums, const char *path,
                               const char digest[RITZ_DIGEST_SIZE]);
void ritz_file_sums_free(ritz_file_sums *sums);

/* The matrix that "FILE[:NAME[#K]]" names: without a name the only one; the
   K-th of that name, from 1. Without K there must be one only. A file whose
   whole name holds a colon is tried first. */
typedef struct ritz_wanted {
    const char *spec;
    const char *what; /* "stiffness", before messages; NULL: nothing is */
    ritz_matrix *into;
} ritz_wanted;

/**
 * Select several matrices. Each file is read once, one file at a time, and of
 * its matrices only those that are wanted.
 *
 * @param[in,out] sums  gets the files; NULL: not wanted
 * @return RITZ_ERR_ARGUMENT listing what a file holds
 */
ritz_status ritz_foreign_collect(int64_t count, const ritz_wanted *wanted,
                                 ritz_file_sums *sums);

/** The part of a spec that names the file; the caller frees @p out. */
ritz_status ritz_foreign_path(const char *spec, char **out);

/* How OUTPUT4 is written. */
typedef struct ritz_output4_style {
    bool text;      /* else binary, native byte order, 32-bit integers */
    bool sparse;    /* else dense */
    int64_t digits; /* text: significant digits, 1 to 17; 17 by default */
} ritz_output4_style;

/** Write matrices as one OUTPUT4 file (draft, then rename). Names are cut to 8
 * letters and capitals. */
ritz_status ritz_output4_write(const char *path, int64_t count,
                               const ritz_matrix *matrix,
                               const ritz_output4_style *style);

/** Write one matrix, 17 digits; symmetric ones as lower triangle; dense ones
 * (all entries stored) as array. Comment lines may be NULL. */
ritz_status ritz_matrix_market_write(const char *path,
                                     const ritz_matrix *matrix,
                                     const char *comment);

void ritz_matrix_free(ritz_matrix *matrix);
void ritz_matrices_free(ritz_matrices *matrices);

/*
 * Decks: the input files of finite-element codes, as far as a component needs
 * them. Of elements only the grids that they join are kept, and the equations
 * of those that make dofs depend on others.
 */

/* Sets of dofs that a code keeps when it reduces matrices. */
enum { RITZ_SET_A, RITZ_SET_B, RITZ_SET_Q, RITZ_NUM_SETS };

typedef struct ritz_deck {
    const struct ritz_deck_format *format; /* that read it */
    ritz_grids grids; /* positions in the basic frame, displacement frames */
    int64_t num_points;
    int64_t *point; /* ids of scalar points, ascending */
    int64_t num_dofs;
    ritz_dof *dof; /* of all grids and points, in the order in which the code
                      numbers the rows of its matrices */
    int64_t num_fixed;
    ritz_dof *fixed; /* supports u = 0, each once, sorted */
    int64_t num_sets[RITZ_NUM_SETS];
    ritz_dof *set[RITZ_NUM_SETS]; /* sorted */
    int64_t num_external;
    ritz_dof *external; /* rows of the matrices of an external superelement, in
                           their order (EXTRN) */
    char *external_twice; /* error sentence if EXTRN names a row twice, as in a
                             deck with two superelements; NULL: it does not */
    int64_t num_constraints;
    char (*constraint)[RITZ_NAME_SIZE]; /* "RBE2 600": what makes dofs depend on
                                           others */
    ritz_equations equations;           /* what these state; `refused` says why
                                           it is not all of that */
    ritz_elements elements; /* for pictures; grids need not be there */
    int64_t num_strange;    /* elements whose grids are not understood */
    char *imposed;    /* sentence about a support that moves its dof; NULL: none
                      does */
    char *unnumbered; /* why `dof` may not be the rows of matrices, which must
                         be named then; NULL: it is */
} ritz_deck;

typedef struct ritz_deck_format {
    const char *name;      /* "bulk" */
    const char *title;     /* "NASTRAN bulk data" */
    const char *reference; /* key in docs/references.bib */
    /** True if these bytes look like the format. @p size may be 0. */
    bool (*recognise)(const char *bytes, int64_t size);
    /**
     * Read the deck; a NUL follows its bytes. A constraint that is not
     * understood is no failure here, but in equations.refused: matrices may
     * have been made without its dofs.
     *
     * @param[in] path    for messages; NULL: they begin with the line
     * @param[in] folder  to which included files are relative
     * @param[out] out    empty; freed by the caller after a failure too
     * @return RITZ_ERR_FORMAT with file and line, and what is wrong there
     */
    ritz_status (*parse)(const char *path, const char *bytes, int64_t size,
                         const char *folder, ritz_deck *out);
} ritz_deck_format;

/** All formats of decks, ended by NULL; the first that recognises a file reads
 * it. */
extern const ritz_deck_format *const ritz_decks[];
extern const ritz_deck_format ritz_deck_cdb;
extern const ritz_deck_format ritz_deck_inp;
extern const ritz_deck_format ritz_deck_nastran;

/** The format of these bytes; NULL if no format knows them. */
const ritz_deck_format *ritz_deck_recognise(const char *bytes, int64_t size);

/** Recognise and read; @return RITZ_ERR_FORMAT if no format knows it. */
ritz_status ritz_deck_read(const char *path, ritz_deck *out);

/** Recognise and read bytes, which a NUL follows. */
ritz_status ritz_deck_parse(const char *path, const char *bytes, int64_t size,
                            const char *folder, ritz_deck *out);

void ritz_deck_free(ritz_deck *deck);

/* From foreign files to a component: what ritz-import does. */

/* Texts as the options of ritz-import take them; NULL or count 0: not given. */
typedef struct ritz_import_request {
    const char *stiffness, *mass, *damping, *structural_damping;
    int64_t num_loads;
    const char *const *load; /* "F@LOAD" */
    int64_t num_preloads;
    const char *const *preload; /* "LOAD=X": stiffness K + X KG of LOAD */
    const char *bulk;           /* file of a deck */
    const char *dofs; /* file of `GRID COMP` rows, or `NODE.COMP` ones */
    const char *rows; /* directions of every grid, "126"; "0": scalar points */
    const char *frequencies; /* of a component in modal form: file of its
                                natural frequencies  [Hz] */
    const char *ratios;      /* file of its damping ratios, or one number */
    int64_t num_ports;
    const char *const *port; /* "NAME=GRIDS[:COMPS]" */
    int64_t num_rigid_ports, num_averaged_ports;
    const char *const *rigid_port; /* "NAME=GRIDS[:COMPS]": a new grid that */
    const char *const *averaged_port; /* these follow, or that follows them */
    int64_t num_inputs;
    const char *const *input; /* "NAME=GRID:COMP[*SCALE][,...]" */
    int64_t num_outputs;
    const char *const *output; /* as inputs, then [/vel|/acc][@LIMIT] */
    const char *input_matrix;  /* matrix B; its inputs follow those of
                                  `input` */
    const char *output_matrix, *velocity_matrix, *acceleration_matrix;
    const char *input_names, *output_names; /* as for a state space */
    int64_t num_recoveries, num_recovery_rows;
    const char *const *recovery;      /* "NAME=F[,KIND]": matrix S of a quantity
                                         to recover, y = S u */
    const char *const *recovery_rows; /* "NAME=FILE": list of the elements or
                                         grids of its rows */
    int64_t num_dampers;
    const char *const *damper; /* "NAME=GRID:COMP[,GRID:COMP]*C[*K]" */
    const char *units;
    bool symmetrise;
    ritz_file_sums *sums; /* gets the files of matrices; NULL: not wanted */
} ritz_import_request;

/* A grid that was made for a port. */
typedef struct ritz_import_grid {
    char port[RITZ_NAME_SIZE];
    int64_t id;
    int64_t num_tied; /* dofs that it is tied to */
} ritz_import_grid;

/* What an import did beyond reading, for the user. */
typedef struct ritz_import_report {
    int64_t num_removed; /* rows empty in K and M */
    ritz_dof *removed;
    int64_t num_fixed; /* rows taken out as the deck fixes them: u = 0 */
    ritz_dof *fixed;
    int64_t num_massless;     /* rows empty in M only: kept */
    int64_t num_floating;     /* rows empty in K only: kept */
    char map[RITZ_NAME_SIZE]; /* where the dofs of the rows were taken from:
                                 "file", "--dofs", "--rows", "modes", "grids
                                 ascending", "A-set", "grids less SPCs", "grids
                                 less dependents", "grids less SPCs and
                                 dependents" */
    int64_t num_constraints;  /* elements that make dofs depend on others */
    char (*constraint)[RITZ_NAME_SIZE]; /* "RBE2 600" */
    int64_t num_eliminated; /* dofs that depend, of rows in the matrices */
    int64_t num_recovered;  /* that follow from the component's dofs */
    int64_t num_lost;       /* that follow from dofs that it has not */
    char *unknown; /* why constraints are not recovered from; NULL: they are */
    int64_t num_hidden; /* elements that no picture shows: their grids are not
                           understood, or not there */
    int64_t num_grids;
    ritz_import_grid *grid; /* made for ports */
} ritz_import_report;

/**
 * Read, name the rows, remove rows empty in both K and M, place grids, set up
 * ports, inputs and outputs, and settle the component.
 *
 * Rows are named by, in this order: --dofs; the map in the file (DMIG); the
 * deck, if its dofs (of NASTRAN six for each grid, ascending, one for scalar
 * points) or its a-set, or its dofs without supports, fit the size; without a
 * deck grids 1, 2, ..., each with the directions that `rows` lists, or with all
 * six if the size is a multiple of six. A size that does not fit is refused.
 * Matrices that name their rows may hold different ones: the component has all
 * of them.
 *
 * Whatever names them, rows that the deck fixes (ritz_deck.fixed) are taken
 * out. Constraint elements (ritz_deck.equations) are applied if the matrices
 * have rows of their dependent dofs, u = G u_n and K_nn = G'KG; otherwise they
 * have been eliminated already. In both cases the dependent dofs go to the
 * component's recovery.
 *
 * A rigid port and an averaged port each add a grid of six dofs at the mean
 * position of the port's grids, along basic axes. The port's dofs follow the
 * added grid of a rigid port as a rigid body. The added grid of an averaged
 * port moves by the unweighted average of the port's dofs, six of which then
 * depend on it and on the others.
 *
 * Inputs and outputs that are given as text act along basic axes. Those that
 * are given as matrices,
 *
 *     M u'' + D u' + K u = B f,    y = C u + Cv u' + Ca u'',
 *
 * refer to the rows of the mass matrix, along displacement axes: B is n x m,
 * and C, Cv and Ca are p x n (n x p where only that fits, and in files that
 * name rows). Constraints are applied to these matrices; entries of fixed dofs
 * are left out. The same holds for the matrix S of a quantity to recover, y =
 * S u. If no kind is given, its name is its kind if that is the name of a kind,
 * and otherwise the kind is "other".
 *
 * Instead of matrices, natural frequencies and optional damping ratios make a
 * component in modal form: K = diag(omega^2), M = I and D = diag(2 zeta omega).
 * Its dofs are the scalar points 1, 2, ...
 *
 * Positions come from the deck alone; a single grid without a deck lies at the
 * origin.
 *
 * @return RITZ_ERR_ARGUMENT, RITZ_ERR_FORMAT, RITZ_ERR_FILE; a constraint
 *         element that is not understood, or contradicts another, an SPC or the
 *         a-set, is refused by name if the matrices have its dofs
 */
ritz_status ritz_import(const ritz_import_request *request, ritz_component *out,
                        ritz_import_report *report);

enum { RITZ_SUPERELEMENT_RECOVERIES = 3 }; /* MUG1, MES1, MEF1 */

/* Files of an external superelement of NASTRAN, as texts of a request. */
/* The files of an external superelement of NASTRAN, as the options of an import
   name them. */
typedef struct ritz_superelement {
    char *stiffness, *mass, *damping, *structural_damping; /* "FILE:NAME"; NULL:
                                                              it has none */
    char *bulk; /* deck that names the rows; NULL: there is none */
    int64_t num_recoveries;
    char *recovery[RITZ_SUPERELEMENT_RECOVERIES];      /* "stress=FILE:MES1" */
    char *recovery_rows[RITZ_SUPERELEMENT_RECOVERIES]; /* "stress=part.pch" */
    int64_t num_others;
    char (*other)[RITZ_NAME_SIZE]; /* matrices that are not read, with their
                                      sizes: "MUG1 36 x 32" */
} ritz_superelement;

/**
 * Find the matrices in FILE.op4 (KAA, MAA, BAA, K4XX, or as NX names them), and
 * the deck FILE.pch or FILE.asm beside it. DMIG in a punch file is its own
 * deck. MUG1, MES1 and MEF1 are rows to recover if a table of the deck, TUG1,
 * TES1 or TEF1, names as many rows.
 * Find the matrices of a superelement in FILE.op4 (KAA, MAA, BAA, K4XX, or the
 * names of NX), and next to it the deck FILE.pch or FILE.asm that names their
 * rows. If the file is a punch file with DMIG, the matrices and the deck are
 * both in it.
 *
 * @param[in] bulk  another deck; NULL: the one beside the file
 * @return RITZ_ERR_FORMAT if there is no stiffness or no mass, or such a table
 *         is not understood; RITZ_ERR_FILE
 */
ritz_status ritz_superelement_find(const char *path, const char *bulk,
                                   ritz_superelement *out);
void ritz_superelement_free(ritz_superelement *found);

/* What the rows of a matrix of recovery are, by a table of NASTRAN. */
typedef struct ritz_row_table {
    int64_t count;
    int64_t *place;               /* grid or element of each row */
    char (*part)[RITZ_NAME_SIZE]; /* "T1" of a grid; "cbar.m1a" */
} ritz_row_table;

/** True if a text may have such a table: a line begins with DTI. */
bool ritz_row_table_recognise(const char *text);

/**
 * Read the table of a kind of quantity: TUG1 of "displacement", TES1 of
 * "stress", TEF1 of "force".
 *
 * @param[in]  path  for messages
 * @param[out] out   without rows if the deck has no such table
 * @return RITZ_ERR_FORMAT if it is not understood
 */
ritz_status ritz_row_table_parse(const char *path, const char *text,
                                 const char *kind, ritz_row_table *out);
void ritz_row_table_free(ritz_row_table *table);

/** Copy "F" out of "NAME=F[,KIND]"; the caller frees @p out.
 * @return RITZ_ERR_ARGUMENT if it is not of this form */
ritz_status ritz_import_recovery_spec(const char *text, char **out);

/* A state space out of files, as the options have it; NULL: not given. */
typedef struct ritz_import_space_request {
    const char *matrices; /* "A=F,B=F,C=F[,D=F][,E=F]" or "FILE[:NAME]" */
    const char *inputs;   /* "NAME,NAME"; u1, u2, ... */
    const char *outputs;  /* "NAME[@LIMIT],NAME"; y1, y2, ... */
    const char *units;
    ritz_file_sums *sums; /* gets the files of matrices; NULL: not wanted */
} ritz_import_space_request;

/**
 * Read A, B and C, and D and E if they are given. A and E stay sparse if there
 * are more than RITZ_SPARSE_STATES states and at most a tenth of their entries
 * is not zero.
 *
 * @return RITZ_ERR_ARGUMENT if one is missing, or there are more than 2
 *         RITZ_STATE_DOFS dense states, inputs or outputs; RITZ_ERR_FORMAT if
 *         sizes disagree, one is complex or not finite, or E is singular
 */
ritz_status ritz_import_state_space(const ritz_import_space_request *request,
                                    ritz_state_space *out);

/**
 * The next file of such `matrices`, as "FILE[:NAME]", into room for as many
 * letters as there are. @return false behind the last
 */
bool ritz_import_space_next(const char **at, char *out);

void ritz_import_report_free(ritz_import_report *report);

#pragma GCC visibility pop

#endif
