#include "epdem/contact.hpp"
#include "epdem/laws.hpp"
#include <cstdio>
using namespace epdem;
int main(){
  using L=Cavity<double>; double par[4]={1.0,1.6,2.8,0.82}; L law(60.0/(1-.04)/1,par);
  BodyShares<double> b=body_shares({30,0.2},{30,0.2},.5), m{1-b.strain_i,1-b.compliance_i,b.bulk_j,b.bulk_i};
  Growing<false,double> g[2]; State<L> st[2]={};
  g[0]=growing_pair(1,.8,{},{},nullptr); g[1]=growing_pair(.8,1,{},{},nullptr);
  double Rs=1/(1+1/.8); double worst=0;
  for(int t=0;t<400;++t){
    double a=.1*sin(t*.01)-.0*t, A=.02*t/400., B=.05*t/400.;
    BodySums<double> i{.001*t/400,A+g[0].state.area,.5,.3*(t>200)*(t-200)/200.}, j{.002*t/400,B+g[0].state.area,.7,.2*(t>200)*(t-200)/200.};
    double F[2]; 
    for(int k=0;k<2;++k){ g[k].i=k?j:i; g[k].j=k?i:j; auto s=grown_step(law,k?m:b,Rs,st[k],a,g[k],false); st[k]=s.step.after; st[k].delta_max=s.delta_max; F[k]=s.step.force; }
    double d=fabs(F[0]-F[1])/(fabs(F[0])+1e-9); if(d>worst){worst=d;printf("%d F %g d %g e %g %g lean %g %g scr %g %g rec %g %g\n",t,F[0],d,g[0].state.retreat,g[1].state.retreat,g[0].state.lean,g[1].state.lean,g[0].state.screening-1,g[1].state.screening-1,g[0].state.recovered,g[1].state.recovered);}
  }
}
