import sys; sys.path.insert(0,'tests')
import numpy as np, csv
from bed import *; from bed_lattices import *; 
def go(E,nu,D,steps=240,rel=60,way=None):
    mat=Material(E,nu,1.0); end=np.pi/6/D
    d=np.linspace(1,end,steps+1)[1:]; 
    back=end+np.linspace(0,way or .12,rel+1)[1:]**1
    p=die_path(mat,np.concatenate([d,back])); F=press([p])[0]
    k=steps-1; top=F[:,1]; end_i=k+np.argmax(top[k:]<=0)
    return F[k],F[end_i] if top[end_i]<=0 else F[-1]
fem={120:{.65:(.00),.80:.27,.90:.31,.95:.33},30:{.80:.43,.90:.56,.95:.60}}
for E,nu in ((120,.34),(30,.2)):
    for D in fem[E]:
        a,b=go(E,nu,D); print(E,D,'side/axial loaded %.3f after/axial %.3f left %.2f (FEM left %.2f)'%(a[0]/a[1]/(1),b[0]/a[1],b[0]/a[0],fem[E][D]),flush=True)
