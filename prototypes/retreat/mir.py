import sys; sys.path[:0]=['tests','tests/engines']
import pathlib,tempfile,numpy as np
from test_mirror_of_hosts import *
T=lambda:pathlib.Path(tempfile.mkdtemp())
law,o='cavity, compaction','alone'
h,w=images(law)
a=lammps(T()/'a',law,o,*h,True); b=lammps(T()/'b',law,o,*w,False)[:,:3]
f=np.abs(a[...,2]-b[...,2]); s=np.abs(a[...,2]).max()
np.set_printoptions(precision=4,linewidth=180)
k=np.flatnonzero((f/s).max(1)>1e-12)[:1][0]; print('onset',k)
for t in range(k-3,k+12): print(t,a[t,:,2]/s,f[t]/s, 1-a[t,0,0])
