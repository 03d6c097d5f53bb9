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
} System;

int sig_free(System *system) {
  if (!system) return 0;
  KSPDestroy(&system->solver);
  MatDestroy(&system->matrix);
  VecDestroy(&system->right);
  VecDestroy(&system->found);
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
