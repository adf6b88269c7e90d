import sys; sys.path[:0]=['tests','tests/verification']
from dense_lattices import *
c=pressed(list(DEVIATIONS))
for n,(D,e) in DEVIATIONS.items(): print(n,np.round(100*deviation(n,D,c[n]),1),e,flush=True)
