units si
boundary s s s
atom_style peri
atom_modify map array
neighbor 0.0005 bin
lattice sc 0.0005
read_data p.data
pair_style peri/lps
pair_coeff * * 14.9e9 6e9 0.0015001 0.0005 0.25
include more
fix 1 all nve
timestep 1e-7
run 1
