//! The parts that a stopped design lacks, in words.

use phea_engineering::design::DesignPart;

/// The sentence on a stopped design without a part.
pub(super) fn unfinished_sentence(part: DesignPart) -> &'static str {
    match part {
        DesignPart::Search => "the search for a controller was not finished: another may be better",
        DesignPart::CommandOfSteps => {
            "the largest command that the steps of the scenarios take was not searched for"
        }
        DesignPart::Trial => {
            "no trial on the nonlinear rig was finished: what it does under this controller is not known"
        }
        DesignPart::Proof => "nothing is proven of the designed controller",
        DesignPart::Relaxations => "what relaxing a limit would buy was not computed",
        DesignPart::WithoutSamples => "the design without samples was not made for comparison",
        DesignPart::GivenController => "the audit of the given controller was not finished",
        DesignPart::Repair => {
            "the repair was not finished: the nonlinear simulation contradicts this controller"
        }
        DesignPart::TemplatesAndBounds => "templates and bounds are not among the files",
    }
}
