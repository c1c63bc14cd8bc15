# a bar under a moving wall
variable s index 2
variable k equal PI/0.0035
units           si
dimension       3
boundary        f f f
atom_style      peri
atom_modify     map array
neighbor        0.0005 bin
lattice         sc 0.0005
region          box block -2 5 -2 4 -2 4
region          body block -0.5 3.5 -0.5 2.5 -0.5 2.5
create_box      1 box
create_atoms    1 region body
pair_style      peri/pmb
pair_coeff      * * 1.6863e22 0.0010001 0.5 0.25
set             group all density 2200
set             group all volume 1.25e-10
region          left block INF 0.0005 INF INF INF INF units box
group           left region left
velocity        all set 0.0 0.0 0.0 sum no units box
fix             F1 all nve
fix             F2 all indent 1e17 sphere 0.0 0.0 0.004 0.001 units box
fix             F3 left setforce 0.0 NULL NULL
timestep        1.0e-7
compute         dmg all damage/atom
compute         worst all reduce max c_dmg
variable        vx atom "10.0*cos(v_k*x) + 2.0e3*y"
velocity        all set v_vx 0.0 0.0 sum no units box
thermo_style    custom step time pe ke c_worst
thermo_modify   format float %.10g
thermo          1
dump            D1 all custom 1 x.dump id type x y z vx c_dmg
if "${s} > 1" then "print 'twice $(v_s*2:%.3f)'" else "print once"
label again
variable n loop 2
next n
run             ${s}
