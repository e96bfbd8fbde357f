% peer_octave.m K M - the job by Octave: eigs, and a solve with 48 right-hand
% sides. K and M are files of PETSc. Prints one JSON object.
1;

function A = load_petsc (path)
  file = fopen (path, 'r', 'ieee-be');
  head = fread (file, 4, 'int32');
  lengths = fread (file, head(2), 'int32');
  columns = fread (file, head(4), 'int32') + 1;
  values = fread (file, head(4), 'double');
  fclose (file);
  rows = repelems (1:head(2), [1:head(2); lengths'])';
  A = sparse (rows, columns, values, head(2), head(3));
end

paths = argv ();
tic; K = load_petsc (paths{1}); M = load_petsc (paths{2}); t_read = toc;
options = struct ('tol', 1e-10);
tic; values = sort (eigs (K, M, 50, 'sm', options)); t_modes = toc;
tic; X = K \ rand (rows (K), 48); t_columns = toc;
printf ('{"phases": {"read": %.4f, "modes": %.4f, "columns": %.4f}, ', ...
        t_read, t_modes, t_columns);
printf ('"values": [%.17g', values(1));
printf (', %.17g', values(2:end));
printf (']}\n');
