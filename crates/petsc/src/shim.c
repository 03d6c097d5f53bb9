/* PETSc and MPI as far as they are needed: processes, sums in a fixed order, and linear systems whose rows are distributed.
   All functions return 0, or what PETSc or MPI says is wrong. Indices are 32-bit integers, as in PETSc by default. */

#include <petscksp.h>
#include <string.h>

_Static_assert(sizeof(PetscInt) == 4, "PETSc with 32-bit indices is needed");
_Static_assert(sizeof(PetscScalar) == 8, "PETSc with real numbers in double precision is needed");

/* An entry of a matrix, as Rust has it. */
typedef struct {
  unsigned row, column;
  double value;
} Entry;

static MPI_Datatype entry_type = MPI_DATATYPE_NULL;

int sig_start(void) {
  int is_started = 0, given = 0;
  MPI_Initialized(&is_started);
  if (!is_started && MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &given)) return 1;
  PetscErrorCode error = PetscInitializeNoArguments();
  if (error) return error;
  /* Signals are handled where they were; errors are returned and told by whoever called. */
  error = PetscPopSignalHandler();
  if (error) return error;
  error = PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  if (error) return error;
  if (MPI_Type_contiguous(sizeof(Entry), MPI_BYTE, &entry_type)) return 1;
  return MPI_Type_commit(&entry_type);
}

int sig_rank(void) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int sig_size(void) {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

void sig_abort(int code) { MPI_Abort(MPI_COMM_WORLD, code); }

/* The end of all processes: waits for those that come later. */
int sig_end(void) {
  MPI_Type_free(&entry_type);
  PetscErrorCode error = PetscFinalize();
  if (error) return error;
  return MPI_Finalize();
}

int sig_broadcast(void *data, int bytes, int from) { return MPI_Bcast(data, bytes, MPI_BYTE, from, MPI_COMM_WORLD); }

int sig_least(int own) {
  int least = own;
  MPI_Allreduce(&own, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return least;
}

/* Numbers of all processes for all: `own` goes to the same place `count` numbers long of each process. */
int sig_to_all(const double *send, const int *send_counts, const int *send_starts, double *receive,
               const int *receive_counts, const int *receive_starts) {
  return MPI_Alltoallv(send, send_counts, send_starts, MPI_DOUBLE, receive, receive_counts, receive_starts, MPI_DOUBLE,
                       MPI_COMM_WORLD);
}

int sig_gather(const double *own, int count, double *all, const int *counts, const int *starts) {
  return MPI_Allgatherv(own, count, MPI_DOUBLE, all, counts, starts, MPI_DOUBLE, MPI_COMM_WORLD);
}

int sig_exchange_counts(const int *send, int *receive) {
  return MPI_Alltoall(send, 1, MPI_INT, receive, 1, MPI_INT, MPI_COMM_WORLD);
}

int sig_exchange(const Entry *send, const int *send_counts, const int *send_starts, Entry *receive,
                 const int *receive_counts, const int *receive_starts) {
  return MPI_Alltoallv(send, send_counts, send_starts, entry_type, receive, receive_counts, receive_starts, entry_type,
                       MPI_COMM_WORLD);
}

/* Options as PETSc has them on its command line. */
int sig_options(const char *text) { return PetscOptionsInsertString(NULL, text); }

/* The names of options that nothing has asked for, one a line. */
int sig_unused_options(char *text, int length) {
  PetscInt count = 0;
  char **names = NULL, **values = NULL;
  text[0] = 0;
  PetscErrorCode error = PetscOptionsLeftGet(NULL, &count, &names, &values);
  if (error) return error;
  for (PetscInt k = 0; k < count; k++) {
    strncat(text, names[k], length - strlen(text) - 1);
    strncat(text, "\n", length - strlen(text) - 1);
  }
  return PetscOptionsLeftRestore(NULL, &count, &names, &values);
}

/* A linear system: its matrix and what solves it. */
typedef struct {
  Mat matrix;
  KSP solver;
  Vec right, found;
  /* Of iterations: bodies with springs in place of multipliers, their multigrid, the forces of multipliers on bodies (columns), what
     the preconditioner makes of residuals of multipliers, and the unknowns of contact, which are factorised by themselves. */
  Mat glued, forces, contact;
  PC multigrid;
  IS of_bodies, of_multipliers, of_contact;
  Vec pull, spring, multiplier, load, left, correction, contact_right, contact_found;
  VecScatter to_contact;
  KSP contact_solver;
} System;

int sig_free(System *system) {
  if (!system) return 0;
  KSPDestroy(&system->solver);
  MatDestroy(&system->matrix);
  VecDestroy(&system->right);
  VecDestroy(&system->found);
  MatDestroy(&system->glued);
  MatDestroy(&system->forces);
  MatDestroy(&system->contact);
  PCDestroy(&system->multigrid);
  ISDestroy(&system->of_bodies);
  ISDestroy(&system->of_multipliers);
  ISDestroy(&system->of_contact);
  Vec *vectors[] = {&system->pull, &system->spring,     &system->multiplier,    &system->load,
                    &system->left, &system->correction, &system->contact_right, &system->contact_found};
  for (int k = 0; k < 8; k++) VecDestroy(vectors[k]);
  VecScatterDestroy(&system->to_contact);
  KSPDestroy(&system->contact_solver);
  free(system);
  return 0;
}

/* Rows of this process in compressed form, columns in the numbers of all. Factorised by MUMPS where the options say nothing else. */
static PetscErrorCode direct(System *system) {
  PC preconditioner;
  PetscCall(KSPSetType(system->solver, KSPPREONLY));
  PetscCall(KSPGetPC(system->solver, &preconditioner));
  PetscCall(PCSetType(preconditioner, PCLU));
  PetscCall(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  return 0;
}

/* Where MUMPS runs out of the room it took, for pivots that it put off as in saddle points, it takes more: percent of its estimate. */
static PetscErrorCode set_up(KSP solver) {
  PC preconditioner;
  PetscBool is_lu = PETSC_FALSE, is_mumps = PETSC_FALSE;
  MatSolverType package = NULL;
  PetscCall(KSPGetPC(solver, &preconditioner));
  PetscCall(PetscObjectTypeCompare((PetscObject)preconditioner, PCLU, &is_lu));
  if (is_lu) {
    PetscCall(PCFactorGetMatSolverType(preconditioner, &package));
    PetscCall(PetscStrcmp(package, MATSOLVERMUMPS, &is_mumps));
  }
  for (PetscInt more = 100;; more *= 4) {
    Mat factor;
    PetscInt info = 0;
    if (is_mumps) {
      PetscCall(PCFactorSetUpMatSolverType(preconditioner));
      PetscCall(PCFactorGetMatrix(preconditioner, &factor));
      PetscCall(MatMumpsSetIcntl(factor, 14, more));
    }
    PetscCall(KSPSetUp(solver));
    if (is_mumps) PetscCall(MatMumpsGetInfog(factor, 1, &info));
    if ((info != -8 && info != -9 && info != -20) || more > 5000) return 0;
    PetscCall(PCReset(preconditioner));
  }
}

static PetscErrorCode build(int rows, int all, const int *start, const int *columns, const double *values, double tolerance,
                            int most, System *system) {
  PetscCall(MatCreateMPIAIJWithArrays(PETSC_COMM_WORLD, rows, rows, all, all, start, columns, values, &system->matrix));
  PetscCall(MatCreateVecs(system->matrix, &system->found, &system->right));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &system->solver));
  PetscCall(KSPSetOperators(system->solver, system->matrix, system->matrix));
  PetscCall(KSPSetErrorIfNotConverged(system->solver, PETSC_FALSE));
  PetscCall(KSPSetTolerances(system->solver, tolerance, 1e-300, 1e10, most));
  PetscCall(direct(system));
  PetscCall(KSPSetFromOptions(system->solver));
  PetscCall(set_up(system->solver));
  return 0;
}

int sig_new(int rows, int all, const int *start, const int *columns, const double *values, double tolerance, int most,
            System **out) {
  System *system = calloc(1, sizeof(System));
  *out = NULL;
  if (!system) return PETSC_ERR_MEM;
  PetscErrorCode error = build(rows, all, start, columns, values, tolerance, most, system);
  if (error) {
    sig_free(system);
    return error;
  }
  *out = system;
  return 0;
}

/* Adds to `found` what the unknowns of contact make of a residual, all others held. */
static PetscErrorCode correct(System *system, Vec residual, Vec found) {
  if (!system->contact_solver) return 0;
  PetscCall(VecScatterBegin(system->to_contact, residual, system->contact_right, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(system->to_contact, residual, system->contact_right, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(KSPSolve(system->contact_solver, system->contact_right, system->contact_found));
  PetscCall(VecScatterBegin(system->to_contact, system->contact_found, found, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecScatterEnd(system->to_contact, system->contact_found, found, ADD_VALUES, SCATTER_REVERSE));
  return 0;
}

/* Bodies with springs: contact, multigrid, contact (Petrides and others 2025). */
static PetscErrorCode smooth(System *system, Vec load, Vec found) {
  PetscCall(VecSet(found, 0.0));
  PetscCall(correct(system, load, found));
  PetscCall(MatMult(system->glued, found, system->left));
  PetscCall(VecAYPX(system->left, -1.0, load));
  PetscCall(PCApply(system->multigrid, system->left, system->correction));
  PetscCall(VecAXPY(found, 1.0, system->correction));
  if (!system->contact_solver) return 0;
  PetscCall(MatMult(system->glued, found, system->left));
  PetscCall(VecAYPX(system->left, -1.0, load));
  return correct(system, system->left, found);
}

/* The step that springs in place of multipliers make of a residual. */
static PetscErrorCode precondition(PC shell, Vec residual, Vec step) {
  System *system;
  Vec of_bodies, of_multipliers, u, own;
  PetscCall(PCShellGetContext(shell, &system));
  PetscCall(VecGetSubVector(residual, system->of_bodies, &of_bodies));
  PetscCall(VecGetSubVector(residual, system->of_multipliers, &of_multipliers));
  PetscCall(VecGetSubVector(step, system->of_bodies, &u));
  PetscCall(VecGetSubVector(step, system->of_multipliers, &own));
  PetscCall(VecPointwiseMult(system->multiplier, system->pull, of_multipliers));
  PetscCall(MatMultAdd(system->forces, system->multiplier, of_bodies, system->load));
  PetscCall(smooth(system, system->load, u));
  PetscCall(MatMultTranspose(system->forces, u, own));
  PetscCall(VecPointwiseMult(own, system->spring, own));
  PetscCall(VecAXPY(own, -1.0, system->multiplier));
  PetscCall(VecRestoreSubVector(step, system->of_multipliers, &own));
  PetscCall(VecRestoreSubVector(step, system->of_bodies, &u));
  PetscCall(VecRestoreSubVector(residual, system->of_multipliers, &of_multipliers));
  PetscCall(VecRestoreSubVector(residual, system->of_bodies, &of_bodies));
  return 0;
}

/* The motions that stretch nothing, for multigrid: orthonormal, without those that others make. */
static PetscErrorCode near_kernel(Mat matrix, int count, const double *motions, int rows) {
  Vec list[6];
  PetscInt kept = 0;
  for (int k = 0; k < count && k < 6; k++) {
    Vec v;
    PetscScalar *write;
    PetscReal before, after;
    PetscCall(MatCreateVecs(matrix, NULL, &v));
    PetscCall(VecGetArrayWrite(v, &write));
    memcpy(write, motions + (size_t)k * rows, (size_t)rows * sizeof(double));
    PetscCall(VecRestoreArrayWrite(v, &write));
    PetscCall(VecNorm(v, NORM_2, &before));
    /* Twice is enough (Kahan). */
    for (int again = 0; again < 2; again++)
      for (PetscInt j = 0; j < kept; j++) {
        PetscScalar along;
        PetscCall(VecDot(v, list[j], &along));
        PetscCall(VecAXPY(v, -along, list[j]));
      }
    PetscCall(VecNorm(v, NORM_2, &after));
    if (after > 1e-8 * before) {
      PetscCall(VecScale(v, 1.0 / after));
      list[kept++] = v;
    } else {
      PetscCall(VecDestroy(&v));
    }
  }
  MatNullSpace kernel;
  PetscCall(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, kept, list, &kernel));
  PetscCall(MatSetNearNullSpace(matrix, kernel));
  PetscCall(MatNullSpaceDestroy(&kernel));
  for (PetscInt j = 0; j < kept; j++) PetscCall(VecDestroy(&list[j]));
  return 0;
}

static PetscErrorCode vector(Vec like, const double *values, int rows, Vec *out) {
  PetscScalar *write;
  PetscCall(VecDuplicate(like, out));
  PetscCall(VecGetArrayWrite(*out, &write));
  memcpy(write, values, (size_t)rows * sizeof(double));
  PetscCall(VecRestoreArrayWrite(*out, &write));
  return 0;
}

static PetscErrorCode contact_solver(System *system, const int *touched, int count) {
  PetscInt all = 0;
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, count, touched, PETSC_COPY_VALUES, &system->of_contact));
  PetscCall(ISGetSize(system->of_contact, &all));
  if (all == 0) return 0;
  PetscCall(MatCreateSubMatrix(system->glued, system->of_contact, system->of_contact, MAT_INITIAL_MATRIX, &system->contact));
  PetscCall(MatCreateVecs(system->contact, &system->contact_found, &system->contact_right));
  PetscCall(VecScatterCreate(system->left, system->of_contact, system->contact_right, NULL, &system->to_contact));
  PC preconditioner;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &system->contact_solver));
  PetscCall(KSPSetOptionsPrefix(system->contact_solver, "contact_"));
  PetscCall(KSPSetOperators(system->contact_solver, system->contact, system->contact));
  PetscCall(KSPSetType(system->contact_solver, KSPPREONLY));
  PetscCall(KSPGetPC(system->contact_solver, &preconditioner));
  PetscCall(PCSetType(preconditioner, PCLU));
  PetscCall(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  PetscCall(KSPSetFromOptions(system->contact_solver));
  return set_up(system->contact_solver);
}

static PetscErrorCode build_glued(int rows, int all, const int *start, const int *columns, const double *values,
                                  int body_rows, int body_all, const int *glued_start, const int *glued_columns,
                                  const double *glued_values, const double *pull, const double *spring, const int *touched,
                                  int touched_count, const double *motions, int motion_count, int components, double tolerance,
                                  int most, System *system) {
  PetscInt first;
  PC shell;
  Vec of_bodies, of_multipliers;
  PetscCall(MatCreateMPIAIJWithArrays(PETSC_COMM_WORLD, rows, rows, all, all, start, columns, values, &system->matrix));
  PetscCall(MatCreateVecs(system->matrix, &system->found, &system->right));
  PetscCall(MatGetOwnershipRange(system->matrix, &first, NULL));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, body_rows, first, 1, &system->of_bodies));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, rows - body_rows, first + body_rows, 1, &system->of_multipliers));
  PetscCall(MatCreateSubMatrix(system->matrix, system->of_bodies, system->of_multipliers, MAT_INITIAL_MATRIX, &system->forces));
  PetscCall(MatCreateMPIAIJWithArrays(PETSC_COMM_WORLD, body_rows, body_rows, body_all, body_all, glued_start, glued_columns,
                                      glued_values, &system->glued));
  PetscCall(MatSetBlockSize(system->glued, components));
  PetscCall(near_kernel(system->glued, motion_count, motions, body_rows));
  PetscCall(MatCreateVecs(system->forces, &of_multipliers, &of_bodies));
  PetscCall(vector(of_multipliers, pull, rows - body_rows, &system->pull));
  PetscCall(vector(of_multipliers, spring, rows - body_rows, &system->spring));
  system->multiplier = of_multipliers;
  system->load = of_bodies;
  PetscCall(VecDuplicate(of_bodies, &system->left));
  PetscCall(VecDuplicate(of_bodies, &system->correction));
  PetscCall(contact_solver(system, touched, touched_count));
  /* Options without a prefix are those of the outer iterations and of the multigrid. */
  PetscCall(PCCreate(PETSC_COMM_WORLD, &system->multigrid));
  PetscCall(PCSetOperators(system->multigrid, system->glued, system->glued));
  PetscCall(PCSetType(system->multigrid, PCGAMG));
  PetscCall(PCSetFromOptions(system->multigrid));
  PetscCall(PCSetUp(system->multigrid));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &system->solver));
  PetscCall(KSPSetOperators(system->solver, system->matrix, system->matrix));
  PetscCall(KSPSetType(system->solver, KSPFGMRES));
  PetscCall(KSPGMRESSetRestart(system->solver, 60));
  PetscCall(KSPSetTolerances(system->solver, tolerance, 1e-300, 1e10, most));
  PetscCall(KSPGetPC(system->solver, &shell));
  PetscCall(PCSetType(shell, PCSHELL));
  PetscCall(PCShellSetContext(shell, system));
  PetscCall(PCShellSetApply(shell, precondition));
  PetscCall(KSPSetSkipPCSetFromOptions(system->solver, PETSC_TRUE));
  PetscCall(KSPSetFromOptions(system->solver));
  return KSPSetUp(system->solver);
}

int sig_new_glued(int rows, int all, const int *start, const int *columns, const double *values, int body_rows, int body_all,
                  const int *glued_start, const int *glued_columns, const double *glued_values, const double *pull,
                  const double *spring, const int *touched, int touched_count, const double *motions, int motion_count,
                  int components, double tolerance, int most, System **out) {
  System *system = calloc(1, sizeof(System));
  *out = NULL;
  if (!system) return PETSC_ERR_MEM;
  PetscErrorCode error =
      build_glued(rows, all, start, columns, values, body_rows, body_all, glued_start, glued_columns, glued_values, pull, spring,
                  touched, touched_count, motions, motion_count, components, tolerance, most, system);
  if (error) {
    sig_free(system);
    return error;
  }
  *out = system;
  return 0;
}

/* The value of an option, empty where it is not given. */
int sig_option(const char *name, char *text, int length) {
  PetscBool is_given = PETSC_FALSE;
  text[0] = 0;
  PetscErrorCode error = PetscOptionsGetString(NULL, NULL, name, text, length, &is_given);
  if (!is_given) text[0] = 0;
  return error;
}

/* Solves once; `reason` is that of PETSc, positive where it converged. */
int sig_solve(System *system, const double *right, double *found, int rows, int *iterations, int *reason) {
  PetscScalar *write;
  const PetscScalar *read;
  KSPConvergedReason why;
  PetscInt count;
  PetscCall(VecGetArrayWrite(system->right, &write));
  memcpy(write, right, (size_t)rows * sizeof(double));
  PetscCall(VecRestoreArrayWrite(system->right, &write));
  PetscCall(KSPSolve(system->solver, system->right, system->found));
  PetscCall(KSPGetConvergedReason(system->solver, &why));
  PetscCall(KSPGetIterationNumber(system->solver, &count));
  PetscCall(VecGetArrayRead(system->found, &read));
  memcpy(found, read, (size_t)rows * sizeof(double));
  PetscCall(VecRestoreArrayRead(system->found, &read));
  *iterations = count;
  *reason = why;
  return 0;
}

/* Whether the type of solver counts iterations. */
int sig_iterates(System *system) {
  PetscBool is_once = PETSC_FALSE;
  PetscObjectTypeCompare((PetscObject)system->solver, KSPPREONLY, &is_once);
  return !is_once;
}
